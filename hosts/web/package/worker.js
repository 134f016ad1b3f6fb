// Reads one scene and answers what is asked of it. A message is a question; each answer has its id.

import init, { Files, Scene } from "./rtc_web.js";

const port =
  typeof postMessage === "function"
    ? { post: postMessage.bind(globalThis), hear: (on) => (globalThis.onmessage = ({ data }) => on(data)) }
    : await import(/* @vite-ignore */ "node:worker_threads").then(({ parentPort }) => ({
        post: (message, moved) => parentPort.postMessage(message, moved),
        hear: (on) => parentPort.on("message", on),
      }));

/** What the library throws has a message and findings; all else is a fault of the program. */
function reason(error) {
  if (!(error instanceof Error) && typeof error === "object") return error;
  return { message: `internal error: ${error.message ?? error}`, findings: [], isBroken: true };
}

function read({ path, files }) {
  const all = new Files();
  for (const [name, bytes] of files) all.add(name, bytes);
  return Scene.read(path, all);
}

const answers = {
  check: (scene) => scene.check(),

  effects: (scene, { settings }) => scene.effects(settings),

  render(scene, { settings }) {
    const start = performance.now();
    const picture = scene.render(settings);
    const seconds = (performance.now() - start) / 1000;
    const size = { width: picture.width(), height: picture.height() };
    const pixels = { rgba: picture.rgba(), linear: picture.linear(), png: picture.png() };
    const numbers = { seconds, rays: picture.rays(), error: picture.error() };
    const findings = picture.findings();
    picture.free();
    return { ...size, ...pixels, ...numbers, findings };
  },
};

let reading = null;

/** Answers one question. */
async function answer({ id, kind, reports, ...more }) {
  globalThis.rtcProgress = reports ? (done, rays) => port.post({ id, kind: "progress", done, rays }) : () => undefined;
  try {
    const result = answers[kind](await reading, more);
    const moved = kind === "render" ? [result.rgba.buffer, result.linear.buffer, result.png.buffer] : [];
    port.post({ id, kind: "done", result }, moved);
  } catch (error) {
    port.post({ id, kind: "failed", ...reason(error) });
  }
}

port.hear((message) => {
  if (message.kind !== "read") return answer(message);
  reading = init({ module_or_path: message.module }).then(() => read(message));
  // It is told to those who ask.
  reading.catch(() => undefined);
});
