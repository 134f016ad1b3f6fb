// Pictures of a page at three widths, light and dark; nothing of it is cut off.

import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import puppeteer from "puppeteer-core";

export const shots = join(fileURLToPath(new URL(".", import.meta.url)), "shots");
mkdirSync(shots, { recursive: true });

/** The browser that CHROMIUM names. */
export const launch = () => {
  const executablePath = process.env.CHROMIUM;
  if (!executablePath) throw new Error("CHROMIUM is to name a browser, as /usr/bin/chromium");
  return puppeteer.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
};

/** Takes the pictures, as shots/NAME-WIDTH-SCHEME.png. */
export const shoot = async (page, name, { fullPage = true } = {}) => {
  for (const [width, height] of [[390, 844], [1280, 900], [1920, 1080]]) {
    for (const scheme of ["light", "dark"]) {
      await page.setViewport({ width, height });
      await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
      await page.screenshot({ path: join(shots, `${name}-${width}-${scheme}.png`), fullPage });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(wide <= 0, `nothing is cut off at ${width}: ${wide}`);
    }
  }
  await page.setViewport({ width: 1280, height: 900 });
};
