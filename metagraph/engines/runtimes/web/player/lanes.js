/** The plan, live: a lane for each layer, now at a third, what is asked above what plays. */

const LAYERS = ["body", "arms", "head"];
const BEFORE = 6, AFTER = 14; // seconds shown
const MARKS = { stance: "●", gesture: "▲", fidget: "◆", transition: "➜" };
const LEFT = 56, TOP = 20;

export class Lanes {
  constructor(canvas, object) {
    this.canvas = canvas;
    this.object = object;
    this.paint = canvas.getContext("2d");
  }

  draw() {
    const { canvas, paint } = this;
    const { plan, now } = this.object.character;
    const scale = Math.min(2, devicePixelRatio), width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
      canvas.width = Math.round(width * scale);
      canvas.height = Math.round(height * scale);
    }
    const look = getComputedStyle(document.documentElement);
    const color = (name) => look.getPropertyValue(`--${name}`).trim();
    const x = (time) => LEFT + ((time - now + BEFORE) / (BEFORE + AFTER)) * (width - LEFT);
    paint.setTransform(scale, 0, 0, scale, 0, 0);
    paint.clearRect(0, 0, width, height);
    paint.font = "12px system-ui, sans-serif";
    paint.textBaseline = "middle";
    paint.save();
    paint.beginPath();
    paint.rect(LEFT, 0, width - LEFT, height);
    paint.clip();
    for (let second = Math.ceil(now - BEFORE); second < now + AFTER; second++) {
      if (second < 0) continue;
      paint.fillStyle = color("line");
      paint.fillRect(Math.round(x(second)), second % 5 ? TOP - 4 : TOP - 8, 1, second % 5 ? 4 : 8);
      if (second % 5) continue;
      paint.fillStyle = color("dim");
      paint.fillText(`${second} s`, x(second) + 4, TOP - 11);
    }
    const tall = (height - TOP - 6) / LAYERS.length;
    LAYERS.forEach((layer, n) => this.lane(plan.layers[layer], TOP + n * tall, tall, x, color, width));
    paint.fillStyle = color("text");
    paint.fillRect(Math.round(x(now)), 0, 1, height);
    paint.restore();
    paint.fillStyle = color("dim");
    LAYERS.forEach((layer, n) => paint.fillText(layer, 14, TOP + n * tall + tall / 2 + 3));
  }

  lane({ metas, cues }, top, tall, x, color, width) {
    const { paint } = this;
    paint.fillStyle = color("line");
    paint.fillRect(LEFT, Math.round(top), width, 1);
    for (const meta of metas) {
      if (x(meta.end) < LEFT || x(meta.start) > width) continue;
      paint.globalAlpha = meta.written ? 0.35 : 1;
      paint.fillStyle = color(meta.request.kind);
      paint.fillRect(x(meta.start), top + 6, Math.max(2, x(meta.end) - x(meta.start) - 1), 3);
    }
    paint.globalAlpha = 1;
    for (const cue of cues) {
      const from = x(cue.start), to = x(cue.end);
      if (to < LEFT || from > width) continue;
      const { kind, name } = cue.action, wide = Math.max(2, to - from - 1), high = tall - 18;
      paint.fillStyle = color("card");
      paint.beginPath();
      paint.roundRect(from, top + 12, wide, high, 4);
      paint.fill();
      paint.strokeStyle = paint.fillStyle = color(kind);
      paint.lineWidth = 1;
      paint.stroke();
      paint.save();
      paint.beginPath();
      paint.rect(from, top + 12, wide, high);
      paint.clip();
      const start = Math.max(from, LEFT) + 6;
      paint.fillText(MARKS[kind], start, top + 12 + high / 2);
      paint.fillStyle = color("text");
      paint.fillText(name, start + 16, top + 12 + high / 2);
      paint.restore();
    }
  }
}
