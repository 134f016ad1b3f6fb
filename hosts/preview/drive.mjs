// Drives the page of `rtc preview` in a browser: an edit, a fault, a button that mends, a turn that
// what it is compared with follows, two fingers, the view written back, a pixel with its effects and its
// line, settings chosen by their costs; and pictures of the page at three widths, light and dark.
//
// CHROMIUM names the browser, RTC the binary [default: target/debug/rtc]; pictures go to shots/.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { launch, shoot, shots } from "./shots.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const rtc = process.env.RTC ?? join(here, "../../target/debug/rtc");

const SCENE = `# Three balls.
Camera:
  eye: [0, 30, 200] # far away
  center: [0, 0, 0]
  up: [0, 0.5, 0]
  viewSize: [240, 180]
Shadows: true
Lights:
- {position: [90, 120, 150], color: [1, 1, 1]}
Objects:
- {type: sphere, position: [-30, 0, 0], radius: 20, material: {color: [0.9, 0.3, 0.2], ka: 0.2, kd: 0.7, ks: 0.4, n: 20}}
- {type: sphere, position: [20, 10, 0], radius: 25, material: {color: [0.2, 0.5, 0.9], ka: 0.2, kd: 0.7, ks: 0.4, n: 20}}
- {type: sphere, position: [0, -15, 30], radius: 8, material: {color: [0.3, 0.8, 0.3], ka: 0.2, kd: 0.7, ks: 0.4, n: 20}}
`;

const folder = mkdtempSync(join(tmpdir(), "rtc-preview-"));
const scene = join(folder, "balls.yaml");
const text = () => readFileSync(scene, "utf8");
writeFileSync(scene, SCENE);
const other = join(folder, "other.yaml");
writeFileSync(other, SCENE.replace("[0.9, 0.3, 0.2]", "[0.9, 0.9, 0.2]"));

/** The picture of a command of the page, perhaps of another scene. */
const rendered = (command, of = "balls.yaml") => {
  const words = command.split(" ").slice(1).map((word) => (word === scene ? join(folder, of) : word));
  return execFileSync(rtc, [...words, "-q", "-o", "-"], { maxBuffer: 1 << 28 });
};

const program = spawn(rtc, ["preview", scene, "--against", other], {
  stdio: ["ignore", "pipe", "inherit"],
});
const ended = new Promise((done) => program.once("exit", done));
const [address] = await new Promise((done) => {
  createInterface({ input: program.stdout }).once("line", (line) => done([line]));
});
const browser = await launch();

try {
  const page = await browser.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error" && !/status of (404|409|503)/.test(message.text())) faults.push(message.text());
  });
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(address);

  // By evaluations alone: to wait in the page would take a function made of text, which its policy forbids.
  const until = async (what, ...args) => {
    for (let turn = 0; turn < 300; turn += 1) {
      if (await page.evaluate(what, ...args)) return;
      await new Promise((done) => setTimeout(done, 100));
    }
    throw new Error(`never ${what}`);
  };
  // The picture that is drawn is the finished one, and differs from that before.
  const finished = async (before) => {
    await until((before) => {
      const number = Number(document.getElementById("picture").dataset.number ?? 0);
      const isIdle = !document.body.classList.contains("is-working");
      return isIdle && state?.picture?.isFinished && state.picture.number === number && number > before;
    }, before);
    return page.$eval("#picture", (canvas) => Number(canvas.dataset.number));
  };
  // The files of what is shown, as the server has them.
  const file = async (path) => {
    const read = async (path) => {
      const { number } = path === "/picture" ? state.picture : state.against;
      const bytes = await (await fetch(url(path, { number }))).arrayBuffer();
      return btoa(Array.from(new Uint8Array(bytes), (byte) => String.fromCharCode(byte)).join(""));
    };
    return Buffer.from(await page.evaluate(read, path), "base64");
  };
  const command = () => page.$eval("#command", (own) => own.value);
  const pixels = () => page.$eval("#picture", (canvas) => canvas.toDataURL());

  let number = await finished(0);
  const first = await pixels();
  await page.screenshot({ path: join(shots, "start-1280.png") });

  writeFileSync(scene, SCENE.replace("radius: 20", "radius: 10"));
  number = await finished(number);
  assert.notEqual(await pixels(), first, "an edit is a new picture");

  writeFileSync(scene, SCENE.replace("radius: 20", "radius: '20'").replace("color: [0.2, 0.5, 0.9]", "color: [0.2 0.5 0.9]"));
  await until(() => !document.getElementById("overlay").hidden);
  const told = await page.$eval("#errors", (errors) => errors.textContent);
  assert.match(told, /error\[/, "the fault is told");
  assert.ok(told.includes("--> balls.yaml:11:") && !told.includes(folder), "paths are relative");
  // The marks stand under what they mark, on a telephone, too.
  const isMarked = () => {
    const marks = document.querySelectorAll("#errors pre");
    const hasMark = (line) => /^\s*\| +[\^_-]/.test(line ?? "");
    const room = (own) => columns(own.parentElement);
    return [...marks].every((own) =>
      own.textContent.split("\n").every((line, k, all) => !hasMark(all[k + 1]) || line.length <= room(own)));
  };
  for (const width of [390, 1280]) {
    await page.setViewport({ width, height: 900 });
    await until(isMarked);
  }
  await shoot(page, "fault", { fullPage: false });
  // By keys alone: the first button, which mends its finding.
  const before = text();
  await page.focus("#errors button");
  await page.keyboard.press("Enter");
  await until((old) => state.load !== old, await page.evaluate(() => state.load));
  assert.notEqual(text(), before, "the button changed the file");
  while (await page.$eval("#errors", (errors) => errors.querySelector("button") !== null)) {
    const load = await page.evaluate(() => state.load);
    await page.click("#errors button");
    await until((old) => state.load !== old && !state.isWorking, load);
  }
  number = await finished(number);
  assert.equal(text(), SCENE, "all is mended");
  assert.equal(await pixels(), first, "and the picture is that of the beginning");

  await page.focus("#picture");
  for (const key of ["ArrowRight", "ArrowRight", "ArrowUp", "+"]) await page.keyboard.press(key);
  await until(() => state.isMoved && state.picture.age > 0 && !document.getElementById("moved").hidden);
  await new Promise((done) => setTimeout(done, 600));
  number = await finished(number);
  assert.notEqual(await pixels(), first, "keys turn the view");
  const box = await (await page.$("#picture")).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.7, box.y + box.height * 0.6, { steps: 8 });
  await page.mouse.up();
  await new Promise((done) => setTimeout(done, 600));
  number = await finished(number);
  await until(() => state.against.age === state.picture.age && state.against.isFinished);
  await until(() => Number(document.getElementById("against").dataset.number) === state.against.number);
  assert.ok((await file("/picture")).equals(rendered(await command())), "the bytes of the command");
  assert.ok((await file("/against")).equals(rendered(await command(), "other.yaml")), "the other follows");

  // On a telephone two fingers that part come nearer, and the page says so.
  const isShown = (kind) => page.$eval(`.for-${kind}`, (own) => own.checkVisibility());
  assert.deepEqual([await isShown("mouse"), await isShown("fingers")], [true, false]);
  await page.setViewport({ width: 390, height: 844, isMobile: true, hasTouch: true });
  await until(() => typeof gaze !== "undefined" && gaze !== null);
  assert.deepEqual([await isShown("mouse"), await isShown("fingers")], [false, true]);
  const distance = () => page.evaluate(() => size(minus(gaze.eye, gaze.center)));
  const [away, small] = [await distance(), await (await page.$("#picture")).boundingBox()];
  const [across, down] = [small.x + small.width / 2, small.y + small.height / 2];
  const fingers = [await page.touchscreen.touchStart(across - 30, down), await page.touchscreen.touchStart(across + 30, down)];
  await fingers[0].move(across - 60, down);
  await fingers[1].move(across + 60, down);
  for (const finger of fingers) await finger.end();
  assert.ok(Math.abs((await distance()) / away - 0.5) < 0.05, "half as far");
  await new Promise((done) => setTimeout(done, 600));
  await finished(number);
  // Another kind of screen reads the page again.
  await page.setViewport({ width: 1280, height: 900 });
  number = await finished(number);

  await page.click("#effects summary");
  await until(() => document.getElementById("verdicts").textContent.includes("shadows"));
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await until(() => document.getElementById("pixel").textContent.includes("value"));
  await until(() => /took part: surfaces \d+×, direct light/.test(document.getElementById("taken").textContent));
  assert.match(await page.$eval("#pixel", (own) => own.textContent), /surface \d: sphere \(balls.yaml:\d+\)/);
  assert.ok((await page.evaluate(() => place)).startsWith(`${scene}:`), "what is copied can be opened");
  await shoot(page, "turned");

  // The panel measures when it is opened, and not before; by keys alone a setting is chosen.
  assert.equal(await page.evaluate(() => state.costs), null);
  await page.focus("#prices summary");
  await page.keyboard.press("Enter");
  await until(() => document.querySelector("#knobs input") !== null);
  await until(() => /rtc render/.test(document.getElementById("costs").textContent));
  assert.match(await page.$eval("#rows", (rows) => rows.textContent), /recommended/);
  await page.focus('#rows button:not([data-values="[]"])');
  const wanted = await page.evaluate(() => document.activeElement.dataset.values);
  await page.keyboard.press("Enter");
  await until((wanted) => ordered(state.choice.values) === wanted && !state.isWorking, wanted);
  number = await finished(number);
  await until(() => document.activeElement.getAttribute("aria-pressed") === "true");
  assert.notEqual(await page.evaluate(() => state.costs), null, "the costs stay");
  assert.ok((await file("/picture")).equals(rendered(await command())), "the bytes of the command");
  await page.focus("#knob-supersampling");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Tab");
  number = await finished(number);
  assert.match(await command(), /--supersampling \d/);
  assert.ok((await file("/picture")).equals(rendered(await command())), "the bytes of the command");
  await page.emulateMediaFeatures([{ name: "prefers-reduced-motion", value: "reduce" }]);
  const moving = await page.evaluate(() => {
    document.body.classList.add("is-working");
    const name = getComputedStyle(document.getElementById("status"), "::before").animationName;
    document.body.classList.remove("is-working");
    return name;
  });
  assert.equal(moving, "none", "nothing moves for who wants that");
  await shoot(page, "settings");
  await page.click("#own");
  number = await finished(number);
  assert.ok(!(await command()).includes("--supersampling"));
  await page.click("#keep");
  await until(() => !state.isMoved && !state.isWorking);
  number = await finished(number);
  assert.match(text(), /eye: \[[^\]]+\] # far away/, "the comment stays");
  assert.ok(!text().includes("[0, 30, 200]"), "the view is in the scene");
  assert.deepEqual(faults, [], "the page has no fault");
} finally {
  await browser.close();
  program.kill("SIGINT");
  const code = await ended;
  rmSync(folder, { recursive: true });
  assert.equal(code, 130);
}
console.log("all is well; the pictures are in hosts/preview/shots");
