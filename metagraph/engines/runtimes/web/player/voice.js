/** Lines heard in step with the lips. */

export class Voice {
  /** @param {Record<string, {audio?: string}>} lines @param {URL} base what their paths are relative to */
  constructor(lines, base) {
    this.sounds = new Map(Object.entries(lines).flatMap(([id, { audio }]) => (audio ? [[id, new URL(audio, base).href]] : [])));
    this.playing = null;
  }

  update({ plan, now }) {
    const speech = plan.track.speeches.find(({ line, start, end }) => this.sounds.has(line) && start <= now && now < end);
    const key = speech ? `${speech.id}@${speech.start}` : null;
    if (this.playing?.key === key || (!speech && !this.playing)) return;
    this.playing?.sound.pause();
    this.playing = null;
    if (!speech) return;
    const sound = new Audio(this.sounds.get(speech.line));
    sound.currentTime = Math.max(0, now - speech.start);
    sound.play().catch(() => {}); // a browser keeps still until somebody has clicked
    this.playing = { key, sound };
  }
}
