// Drives the page of dist/ in a browser: its pictures are those of the binary, byte for byte; a slip is found and mended by
// its button; a link carries the scene; and pictures of the page at three widths, light and dark.
//
// CHROMIUM names the browser, RTC the binary [default: target/release/rtc]; words are names of scenes, all of them for --all.
// Pictures go to shots/.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { createReadStream, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import puppeteer from "puppeteer-core";

const here = fileURLToPath(new URL(".", import.meta.url));
const rtc = process.env.RTC ?? join(here, "../../target/release/rtc");
const browserPath = process.env.CHROMIUM;
if (!browserPath) throw new Error("CHROMIUM is to name a browser, as /usr/bin/chromium");
const dist = join(here, "dist");
const known = Object.keys(JSON.parse(readFileSync(join(dist, "scenes.json"), "utf8"))).map((name) => name.replace(".yaml", ""));
const words = process.argv.slice(2);
const named = words.length > 0 ? words : ["camera", "five-spheres", "globe", "terminator", "vases"];
const names = words[0] === "--all" ? known : named;

const kinds = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };
const server = createServer(({ url }, reply) => {
  const path = join(dist, normalize(new URL(url, "http://here").pathname.replace(/\/$/, "/index.html")));
  if (!existsSync(path)) return reply.writeHead(404).end();
  reply.writeHead(200, { "Content-Type": kinds[extname(path)] ?? "application/octet-stream" });
  createReadStream(path).pipe(reply);
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const origin = `http://127.0.0.1:${server.address().port}`;
const shots = join(here, "shots");
mkdirSync(shots, { recursive: true });
const folder = mkdtempSync(join(tmpdir(), "rtc-web-"));

/** The hash of the file that the binary makes. */
function native(name) {
  const picture = join(folder, `${name}.png`);
  execFileSync(rtc, ["render", "-q", join(here, `../../scenes/${name}.yaml`), "-o", picture]);
  return createHash("sha256").update(readFileSync(picture)).digest("hex");
}

const browser = await puppeteer.launch({ executablePath: browserPath, args: ["--no-sandbox", "--disable-gpu"] });
const faults = [];

async function visit(address) {
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 900 });
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(`${origin}/`) && !/^(data|blob):/.test(url)) faults.push(`it asks for ${url}`);
  });
  await page.goto(address);
  return page;
}

/** Waits for the page to say so, for ten minutes: some scenes take long. */
async function said(page, what, id = "status") {
  for (let turn = 0; turn < 6000; turn += 1) {
    if ((await text(page, id)).match(what)) return;
    await new Promise((done) => setTimeout(done, 100));
  }
  throw new Error(`#${id} never said ${what}, but ${await text(page, id)}`);
}

const text = (page, id) => page.$eval(`#${id}`, (own) => own.textContent);
const type = (page, value) =>
  page.$eval("#text", (field, value) => {
    field.value = value;
    field.dispatchEvent(new Event("input", { bubbles: true }));
  }, value);

async function shoot(page, name) {
  for (const [width, height] of [[390, 844], [1280, 900], [1920, 1080]]) {
    for (const scheme of ["light", "dark"]) {
      await page.setViewport({ width, height });
      await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
      await page.screenshot({ path: join(shots, `${name}-${width}-${scheme}.png`), fullPage: true });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(wide <= 0, `nothing is cut off at ${width}: ${wide}`);
    }
  }
  await page.setViewport({ width: 1280, height: 900 });
}

try {
  for (const name of names) {
    const page = await visit(`${origin}/#scene=${name}`);
    await said(page, /^finished/);
    assert.equal(await text(page, "hash"), native(name), `the file of ${name}`);
    console.log(`${name}: ${await text(page, "made")}, the bytes of the binary`);
    await page.close();
  }

  const page = await visit(`${origin}/#scene=five-spheres`);
  await said(page, /^finished/);
  const hash = await text(page, "hash");
  const sound = await page.$eval("#text", (field) => field.value);
  await page.click("#explained summary");
  assert.match(await text(page, "effects"), /shadows/);
  await shoot(page, "picture");

  await type(page, `# 😀\n${sound.replace("Objects:", "Objcts:")}`);
  await said(page, /SC001[^]*Objects/, "findings");
  await said(page, /^(finished|no picture)/);
  await page.click("#findings details summary");
  await shoot(page, "fault");
  const button = await page.waitForSelector("#findings button ::-p-text(Put `Objects`)");
  await button.focus();
  await page.keyboard.press("Enter");
  await said(page, /^finished/);
  assert.equal(await page.$eval("#text", (field) => field.value), `# 😀\n${sound}`);
  assert.equal(await text(page, "hash"), hash, "a comment changes nothing");

  const changed = `# é\n${sound}`.replace("radius: 50", "radius: 20");
  await type(page, changed);
  await said(page, /^finished/);
  await page.click("#share");
  await said(page, /^the address/);
  const other = await visit(await page.evaluate(() => location.href));
  await said(other, /^finished/);
  assert.equal(await other.$eval("#text", (field) => field.value), changed);
  assert.equal(await text(other, "hash"), await text(page, "hash"));
  assert.notEqual(await text(other, "hash"), hash);

  await other.type("#amount", "\b2");
  await other.click("#cost button");
  await said(other, /^measured/);
  assert.match(await text(other, "costs"), /times as long.* grey levels/);
  assert.deepEqual(faults, [], "the page has no fault");
} finally {
  await browser.close();
  server.close();
  rmSync(folder, { recursive: true });
}
console.log("all is well; the pictures are in hosts/web/shots");
