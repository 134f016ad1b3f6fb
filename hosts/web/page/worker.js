// Reads and renders one scene at a time, beside the page. A message is a job; each answer has its id.

import init, { Files, Scene, Settings } from "./rtc_web.js";

/** What the library throws is JSON; all else is a fault of the program. */
function reason(error) {
  if (typeof error === "string") return JSON.parse(error);
  return { message: `internal error: ${error.message ?? error}`, findings: [], isBroken: true };
}

function settingsOf({ width, height, supersampling, samples, depth }) {
  let settings = new Settings();
  if (width && height) settings = settings.size(width, height);
  if (supersampling) settings = settings.supersampling(supersampling);
  if (samples) settings = settings.samples(samples);
  if (depth !== undefined) settings = settings.depth(depth);
  return settings;
}

function read({ path, files }) {
  const all = new Files();
  for (const [name, bytes] of files) all.add(name, bytes);
  return Scene.read(path, all);
}

function rendered(scene, words) {
  const start = performance.now();
  const picture = scene.render(settingsOf(words));
  const seconds = (performance.now() - start) / 1000;
  return { picture, seconds, rays: picture.rays(), rgba: picture.rgba() };
}

const jobs = {
  /** What is found and what the picture needs at once; then the picture. */
  show(job, say) {
    const scene = read(job);
    say("findings", { findings: JSON.parse(scene.check()) });
    const effects = JSON.parse(scene.effects(settingsOf(job.settings)));
    const { picture, seconds, rays, rgba } = rendered(scene, job.settings);
    const findings = JSON.parse(picture.findings());
    const size = { width: picture.width(), height: picture.height() };
    say("picture", { ...size, seconds, rays, rgba, png: picture.png(), findings, effects });
  },

  /** The pictures of two settings: how long each takes, and how far they are apart. */
  compare(job, say) {
    const scene = read(job);
    const [a, b] = job.both.map((settings) => rendered(scene, settings));
    let sum = 0;
    a.rgba.forEach((byte, index) => (sum += index % 4 === 3 ? 0 : (byte - b.rgba[index]) ** 2));
    const levels = Math.sqrt(sum / ((a.rgba.length / 4) * 3));
    say("compared", { seconds: [a.seconds, b.seconds], rays: [a.rays, b.rays], levels });
  },
};

let ready = null;
onmessage = async ({ data: job }) => {
  const say = (kind, more) => postMessage({ id: job.id, kind, ...more });
  try {
    ready ??= init({ module_or_path: job.module });
    await ready;
    jobs[job.kind](job, say);
  } catch (error) {
    say("failed", reason(error));
  }
};
