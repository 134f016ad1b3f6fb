// Looks at the page of a study in a browser: a mark of the plot says its values to the pointer and to the
// keyboard, the slider says what a time buys; and pictures of the page at three widths, light and dark.
//
// CHROMIUM names the browser, RTC the binary [default: target/debug/rtc]; STUDY a page that is there
// already [default: a quick study of scenes/soft-light.yaml]. Pictures go to shots/.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { launch, shoot } from "./shots.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const rtc = process.env.RTC ?? join(root, "target/debug/rtc");
const folder = mkdtempSync(join(tmpdir(), "rtc-study-"));
const made = join(folder, "study.html");
if (!process.env.STUDY) {
  const scene = join(root, "scenes/soft-light.yaml");
  execFileSync(rtc, ["cost", scene, "--effort", "quick", "--html", made, "-q"]);
}
const browser = await launch();

try {
  const page = await browser.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(String(error)));
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(pathToFileURL(resolve(process.env.STUDY ?? made)).href);

  const said = () => page.$eval(".plot .said", (own) => own.textContent);
  const told = await page.$$eval(".plot .spot", (spots) => spots.map((spot) => spot.getAttribute("aria-label")));
  assert.ok(told.length > 2, "there are marks");
  await page.hover(".plot .spot:last-of-type");
  assert.ok(told.includes(await said()), `the pointer: ${await said()}`);
  await page.$eval(".plot .spot", (spot) => spot.focus());
  assert.equal(await said(), told[0], "the keyboard");
  await page.click("details summary");
  const buys = () => page.$eval(".buys .at", (own) => own.textContent);
  const most = await buys();
  await page.focus('input[aria-label="time"]');
  await page.keyboard.press("Home");
  assert.ok((await buys()) !== most || (await page.$$(".buys li")).length === 1, "less time buys less");
  await shoot(page, "study");
  assert.deepEqual(faults, [], "the page has no fault");
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}
console.log("all is well; the pictures are in hosts/preview/shots");
