// Tests of the package in dist/package in Node: its pictures are those of the binary, its types hold.
//
// RTC names the binary [default: target/release/rtc].

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { SceneError, load } from "./dist/package/index.js";

const here = fileURLToPath(new URL(".", import.meta.url));
const rtc = process.env.RTC ?? join(here, "../../target/release/rtc");
const scenes = join(here, "../../scenes");
const text = readFileSync(join(scenes, "five-spheres.yaml"), "utf8");

function native(name) {
  const folder = mkdtempSync(join(tmpdir(), "rtc-package-"));
  try {
    const picture = join(folder, "picture.png");
    execFileSync(rtc, ["render", "-q", join(scenes, name), "-o", picture]);
    return readFileSync(picture);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test("the module is at most 2.5 MB compressed", () => {
  const module = readFileSync(join(here, "dist/package/rtc_web_bg.wasm"));
  const size = gzipSync(module, { level: 9 }).length;
  assert.ok(size <= 2_500_000, `${size}`);
});

test("a picture has the bytes of the binary", async () => {
  const scene = await load("five-spheres.yaml", text);
  const shares = [];
  const picture = await scene.render({}, { onProgress: ({ done }) => shares.push(done) });
  assert.deepEqual(Buffer.from(picture.png), native("five-spheres.yaml"));
  assert.equal(picture.rgba.length, 4 * picture.width * picture.height);
  assert.equal(picture.linear.length, 3 * picture.width * picture.height);
  assert.ok(shares.length > 2 && shares.at(-1) === 1, `${shares}`);
  assert.deepEqual(shares, [...shares].sort((a, b) => a - b));
  scene.close();
});

test("a file is read from the disk, and files beside the scene are named", async () => {
  const alone = await load(new URL("../../scenes/five-spheres.yaml", import.meta.url));
  assert.equal((await alone.render({ width: 8, height: 6 })).width, 8);
  const beside = { "vases.yaml": readFileSync(join(scenes, "vases.yaml")), "vase.glb": readFileSync(join(scenes, "vase.glb")) };
  const vases = await load("vases.yaml", beside);
  const effects = await vases.effects();
  assert.ok(effects.some(({ name, state }) => name === "shadows" && state === "needed"), JSON.stringify(effects));
  [alone, vases].forEach((scene) => scene.close());
});

test("a scene with an error throws its findings", async () => {
  const scene = await load("a.yaml", text.replace("radius: 50", "radius: -50"));
  const failed = await scene.render().catch((error) => error);
  assert.deepEqual(failed.findings[0], (await scene.check())[0]);
  scene.close();
  assert.ok(failed instanceof SceneError, String(failed));
  assert.match(failed.findings[0].text, /radius/);
  assert.equal(failed.findings[0].severity, "error");
  await assert.rejects(load("a.yaml", { "b.yaml": text }), SceneError);
  await assert.rejects(load("none.yaml"), /ENOENT/);
});

test("a wrong setting is an error of that render alone", async () => {
  const scene = await load("a.yaml", text);
  await assert.rejects(scene.render({ widht: 8 }), /widht/);
  await assert.rejects(scene.render({ width: 0, height: 8 }), SceneError);
  assert.equal((await scene.render({ width: 4, height: 4 })).height, 4);
  scene.close();
});

test("a render is aborted, and the scene stays usable", async () => {
  const scene = await load("a.yaml", text);
  const abort = new AbortController();
  const onProgress = () => abort.abort();
  await assert.rejects(scene.render({ width: 2000, height: 2000 }, { onProgress, signal: abort.signal }), { name: "AbortError" });
  assert.equal((await scene.render({ width: 4, height: 4 })).height, 4);
  scene.close();
  const closed = await load("a.yaml", text);
  const render = closed.render({ width: 2000, height: 2000 });
  closed.close();
  await assert.rejects(render, /closed/);
});
