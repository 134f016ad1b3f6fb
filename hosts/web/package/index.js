// Scenes that are checked and rendered in a worker, so that the page or the program goes on meanwhile.

const isNode = typeof process !== "undefined" && Boolean(process.versions?.node);

/** Why there is no scene or no picture; `findings` explain it. */
export class SceneError extends Error {
  name = "SceneError";

  constructor({ message, findings = [] }) {
    super(message);
    this.findings = findings;
  }
}

async function bytesOf(url) {
  if (isNode && url.protocol === "file:") {
    const { readFile } = await import(/* @vite-ignore */ "node:fs/promises");
    return new Uint8Array(await readFile(url));
  }
  const reply = await fetch(url);
  if (!reply.ok) throw new SceneError({ message: `${url} cannot be read: ${reply.status} ${reply.statusText}` });
  return new Uint8Array(await reply.arrayBuffer());
}

let compiled = null;

/** The module, compiled once. */
function module() {
  compiled ??= bytesOf(new URL("./rtc_web_bg.wasm", import.meta.url)).then((bytes) => WebAssembly.compile(bytes));
  return compiled;
}

/** A worker of the browser or of Node, with one way to speak to it. */
async function startWorker() {
  const url = new URL("./worker.js", import.meta.url);
  if (!isNode) {
    const worker = new Worker(url, { type: "module" });
    return {
      post: (message) => worker.postMessage(message),
      stop: () => worker.terminate(),
      hear(onMessage, onFault) {
        worker.onmessage = ({ data }) => onMessage(data);
        worker.onerror = ({ message }) => onFault(message);
      },
    };
  }
  const { Worker: Thread } = await import(/* @vite-ignore */ "node:worker_threads");
  const worker = new Thread(url);
  // A program ends although a scene is open; while it waits for an answer, it does not.
  worker.unref();
  return {
    post(message) {
      worker.ref();
      worker.postMessage(message);
    },
    stop: () => worker.terminate(),
    hear(onMessage, onFault) {
      worker.on("message", (data) => {
        if (data.kind !== "progress") worker.unref();
        onMessage(data);
      });
      worker.on("error", ({ message }) => onFault(message));
    },
  };
}

/** A scene that was read. It has a worker of its own; `close` ends that. */
class Scene {
  #path;
  #files;
  #worker = null;
  #open = new Map();
  #last = 0;

  constructor(path, files) {
    this.#path = path;
    this.#files = files;
  }

  check(options) {
    return this.#ask("check", {}, options);
  }

  effects(settings = {}) {
    return this.#ask("effects", { settings });
  }

  render(settings = {}, { onProgress, signal } = {}) {
    return this.#ask("render", { settings }, { onProgress, signal });
  }

  close() {
    this.#end(new SceneError({ message: "the scene was closed" }));
  }

  /** Reads the scene in a new worker, unless there is one. */
  async #started() {
    this.#worker ??= (async () => {
      const worker = await startWorker();
      worker.hear(
        (data) => this.#hear(data),
        (message) => this.#end(new SceneError({ message: `internal error: ${message}` })),
      );
      worker.post({ kind: "read", module: await module(), path: this.#path, files: this.#files });
      return worker;
    })();
    return this.#worker;
  }

  /** Ends the worker; what waits for it fails. */
  #end(error) {
    this.#worker?.then((worker) => worker.stop(), () => undefined);
    this.#worker = null;
    for (const { fail } of this.#open.values()) fail(error);
    this.#open.clear();
  }

  #hear({ id, kind, ...rest }) {
    const job = this.#open.get(id);
    if (kind === "progress") return job?.onProgress?.(rest);
    this.#open.delete(id);
    if (kind === "done") return job?.done(rest.result);
    job?.fail(new SceneError(rest));
    // What has panicked cannot be used again.
    if (rest.isBroken) this.#end(new SceneError(rest));
  }

  async #ask(kind, more = {}, { onProgress, signal } = {}) {
    signal?.throwIfAborted();
    this.#last += 1;
    const id = this.#last;
    // Rendering holds the worker, so it is ended; the next question reads the scene again.
    const stop = () => this.#end(signal.reason);
    signal?.addEventListener("abort", stop);
    try {
      return await new Promise((done, fail) => {
        this.#open.set(id, { done, fail, onProgress });
        const post = (worker) => this.#open.has(id) && worker.post({ id, kind, reports: Boolean(onProgress), ...more });
        this.#started().then(post, (error) => this.#end(error));
      });
    } finally {
      signal?.removeEventListener("abort", stop);
    }
  }
}

function asBytes(data) {
  return typeof data === "string" ? new TextEncoder().encode(data) : new Uint8Array(data);
}

async function filesOf(path, content) {
  if (content === undefined) return [[path, await bytesOf(addressOf(path))]];
  const isOne = typeof content === "string" || content instanceof ArrayBuffer || ArrayBuffer.isView(content);
  const files = isOne ? [[path, content]] : content instanceof Map ? [...content] : Object.entries(content);
  return files.map(([name, data]) => [name, asBytes(data)]);
}

/** A path as an address: of the page, or of the working folder. */
function addressOf(path) {
  return new URL(path, isNode ? new URL(`file://${process.cwd()}/`) : document.baseURI);
}

export async function load(path, content, options) {
  const name = String(path);
  const scene = new Scene(name, await filesOf(name, content));
  try {
    // Reads it, so that a scene that cannot be read fails here.
    await scene.check(options);
  } catch (error) {
    scene.close();
    throw error;
  }
  return scene;
}
