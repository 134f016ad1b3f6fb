// The extension in VS Code itself, as code-server has it in a browser: a finding appears, its quick fix
// mends the file, and the picture is shown beside.
//
// CHROMIUM names the browser, CODE_SERVER the program (code-server's out/node/entry.js), RTC the binary
// [default: target/debug/rtc]; `npm run package` comes before. A picture of the window goes to shots/.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer, request } from "node:http";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import puppeteer from "puppeteer-core";

const SCENE = `# A ball.
Camera: {eye: [0, 0, 50], center: [0, 0, 0], up: [0, 1, 0], viewSize: [60, 40]}
Shadws: true
Lights: [{position: [9, 9, 90], color: [1, 1, 1]}]
Objects:
- {type: sphere, position: [0, 0, 0], radius: 15, material: {color: [1, 0.5, 0], ka: 0.2, kd: 0.7, ks: 0, n: 1}}
`;

const here = fileURLToPath(new URL(".", import.meta.url));
const rtc = resolve(process.env.RTC ?? join(here, "../../target/debug/rtc"));
const { CHROMIUM, CODE_SERVER } = process.env;
if (!CHROMIUM || !CODE_SERVER) throw new Error("CHROMIUM and CODE_SERVER are to name programs");

const folder = mkdtempSync(join(tmpdir(), "rtc-code-"));
const at = (...names) => join(folder, ...names);
for (const own of ["data/User", "extensions", "work/scenes"]) mkdirSync(at(own), { recursive: true });
const scene = at("work/scenes/ball.yaml");
writeFileSync(scene, SCENE);
const settings = { "rtc.path": rtc, "security.workspace.trust.enabled": false, "workbench.startupEditor": "none" };
writeFileSync(at("data/User/settings.json"), JSON.stringify(settings));
writeFileSync(at("config.yaml"), "auth: none\nbind-addr: 127.0.0.1:0\n");
const words = [CODE_SERVER, "--config", at("config.yaml"), "--user-data-dir", at("data"), "--extensions-dir", at("extensions")];
execFileSync("node", [...words, "--install-extension", join(here, "dist/rtc-scenes.vsix")], { stdio: "inherit" });

// In a browser VS Code has ports of its machine forwarded under other names, and holds their pages within a page of the
// web. The preview refuses both: it is for VS Code of a desktop. So a forwarder stands between, which makes one of the other.
const forwarder = createServer((asked, answer) => {
  const port = parseInt(asked.headers.host, 10);
  const { origin: _, ...headers } = asked.headers;
  const options = { port, path: asked.url, method: asked.method, headers: { ...headers, host: `127.0.0.1:${port}` } };
  const forwarded = request(options, (reply) => {
    const { "content-security-policy": _, ...told } = reply.headers;
    answer.writeHead(reply.statusCode, told);
    reply.pipe(answer);
  });
  forwarded.on("error", () => answer.destroy());
  asked.pipe(forwarded);
});
await new Promise((done) => forwarder.listen(0, "127.0.0.1", done));
const env = { ...process.env, VSCODE_PROXY_URI: `http://{{port}}.localhost:${forwarder.address().port}/` };
const quiet = ["--disable-telemetry", "--disable-update-check", "--disable-workspace-trust"];
const server = spawn("node", [...words, ...quiet, at("work")], { env, stdio: ["ignore", "pipe", "ignore"] });
const address = await new Promise((done) => {
  createInterface({ input: server.stdout }).on("line", (line) => {
    const found = /HTTP server listening on (http:\S+?)\/?$/.exec(line);
    if (found) done(found[1]);
  });
});
const browser = await puppeteer.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", "--disable-gpu"] });
const pause = (time) => new Promise((done) => setTimeout(done, time));
const shots = join(here, "shots");
mkdirSync(shots, { recursive: true });

try {
  const page = await browser.newPage();
  await page.setViewport({ width: 1400, height: 900 });
  const until = async (what, look) => {
    for (let turn = 0; turn < 300; turn += 1) {
      const found = await look().catch(() => null);
      if (found) return found;
      await pause(200);
    }
    await page.screenshot({ path: join(shots, "never.png") });
    throw new Error(`never: ${what}`);
  };
  const has = (selector) => () => page.$(selector);
  const command = async (name) => {
    await page.keyboard.press("F1");
    await until("commands", has(".quick-input-widget input"));
    await page.keyboard.type(name);
    await pause(1000);
    await page.keyboard.press("Enter");
  };
  const payload = JSON.stringify([["openFile", `vscode-remote://${new URL(address).host}${scene}`]]);
  await page.goto(`${address}/?folder=${encodeURIComponent(at("work"))}&payload=${encodeURIComponent(payload)}`);

  await until("a finding", has(".monaco-editor .squiggly-error, .monaco-editor .squiggly-warning"));
  await page.screenshot({ path: join(shots, "finding.png") });
  await page.click(".monaco-editor .view-lines");
  await command("Go to Next Problem (Error, Warning, Info)");
  await pause(1000);
  await page.keyboard.press("Escape");
  await page.keyboard.down("Control");
  await page.keyboard.press(".");
  await page.keyboard.up("Control");
  await until("quick fixes", has(".action-widget .monaco-list-row"));
  await pause(500);
  await page.screenshot({ path: join(shots, "fixes.png") });
  await page.keyboard.press("Enter");
  await command("File: Save");
  await until("the mended file", async () => readFileSync(scene, "utf8") === SCENE.replace("Shadws", "Shadows"));

  await command("rtc: Show the Picture Beside");
  const picture = async () => {
    const frame = page.frames().find((own) => own.url().includes("token="));
    return frame?.evaluate(() => Number(document.getElementById("picture").dataset.number ?? 0) > 0);
  };
  await until("the picture", picture);
  await pause(1000);
  await page.screenshot({ path: join(shots, "beside.png") });
  assert.equal(await page.$(".monaco-editor .squiggly-error"), null, "nothing is left to mend");
} finally {
  await browser.close();
  forwarder.closeAllConnections();
  forwarder.close();
  server.kill();
  await new Promise((done) => server.once("exit", done));
  rmSync(folder, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
}
console.log("all is well; the pictures are in hosts/vscode/shots");
