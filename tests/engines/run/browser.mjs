// node browser.mjs FOLDER STEPS.json: serves a folder on the loopback, opens it in headless Chromium, runs steps in the page, and prints
// their values, then the errors that the browser told, a JSON a line. Without words it stays, reads {"folder", "steps", "scheme"} a line and
// answers each with {"values", "errors", "failed"}: each has a page of its own that remembers nothing, in a browser that is started once.
// STEPS: [{"url": path}, {"run": "JavaScript whose value is printed"}, {"wait": ms}, {"shot": "file.png"}, {"click": selector}, {"press": key}, {"size": [width, height]}, {"download": [selector, "file"]}, ...]
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import readline from "node:readline";
import { chromium } from "playwright-core";

const KINDS = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".json": "application/json", ".glb": "model/gltf-binary", ".wasm": "application/wasm" };
const executablePath = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(fs.existsSync);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });

async function served(folder) {
  const server = http.createServer((request, answer) => {
    const file = path.join(folder, decodeURIComponent(new URL(request.url, "http://x").pathname).replace(/\/$/, "/index.html"));
    if (!file.startsWith(path.resolve(folder)) || !fs.existsSync(file)) return answer.writeHead(404).end();
    answer.writeHead(200, { "content-type": KINDS[path.extname(file)] ?? "application/octet-stream" }).end(fs.readFileSync(file));
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return server;
}

/// Runs steps in a page of a folder; `say` is given each value and at last the errors.
async function browsed(folder, steps, colorScheme, say) {
  const server = await served(folder);
  const base = `http://127.0.0.1:${server.address().port}/`;
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, colorScheme });
  const page = await context.newPage();
  const errors = [];
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error)));
  async function until(words) {  // asked from outside, since a page may forbid eval
    for (const end = Date.now() + 30000; ; await page.waitForTimeout(40)) {
      if (await page.evaluate(`Boolean(${words})`).catch(() => false)) return; // a whole scene would take seconds to come over
      if (Date.now() > end) throw new Error(`never came true: ${words}`);
    }
  }
  try {
    for (const step of steps) {
      if (step.size) await page.setViewportSize({ width: step.size[0], height: step.size[1] });
      if (step.url !== undefined) await page.goto(new URL(step.url, base).href);
      if (step.until) await until(step.until);
      if (step.run) say({ value: await page.evaluate(step.run) ?? null });
      if (step.click) await page.click(step.click);
      if (step.fill) await page.fill(...step.fill);
      if (step.press) await page.keyboard.press(step.press);
      if (step.download) await (await Promise.all([page.waitForEvent("download"), page.click(step.download[0])]))[0].saveAs(step.download[1]);
      if (step.wait) await page.waitForTimeout(step.wait);
      if (step.shot) await page.screenshot({ path: step.shot });
    }
  } finally {
    say({ errors });
    await context.close();
    server.close();
    server.closeAllConnections();
  }
}

try {
  const [folder, script] = process.argv.slice(2);
  if (folder) {
    await browsed(folder, JSON.parse(fs.readFileSync(script)), process.env.SCHEME ?? "dark", (row) => console.log(JSON.stringify(row)));
  } else {
    for await (const line of readline.createInterface({ input: process.stdin })) {
      const { folder, steps, scheme } = JSON.parse(line);
      const answer = { values: [], errors: [] };
      const say = (row) => ("value" in row ? answer.values.push(row.value) : answer.errors.push(...row.errors));
      await browsed(folder, steps, scheme, say).catch((error) => (answer.failed = String(error.stack)));
      console.log(JSON.stringify(answer));
    }
  }
} finally {
  await browser.close();
}
