// The page: a scene that is edited, what is found in it, and its picture.

import { packed, unpacked } from "./link.js";
import { load } from "./package/index.js";
import { showEffects, showFindings } from "./told.js";

const at = (id) => document.getElementById(id);
const REST = 400;
const SCENE = /\.(ya?ml|json|gltf|glb|obj|ply|stl|off|rtir)$/i;
const TEXT = /\.(ya?ml|json|gltf|obj)$/i;

const [known, codes] = await Promise.all(["scenes.json", "codes.json"].map(async (name) => (await fetch(name)).json()));

/** The scene: its path, the files beside its text, and the text as it was if it is one of the list. */
let scene = { path: "scene.yaml", others: [], original: null };
/** Ends the job that runs. */
let running = new AbortController();
let resting = null;

/** Reads the scene and works on it, instead of the job that runs. */
async function start(work) {
  running.abort();
  const { signal } = (running = new AbortController());
  let opened = null;
  try {
    opened = await load(scene.path, new Map(files()), { signal });
    await work(opened, signal);
  } catch (error) {
    if (!signal.aborted) failed(error);
  } finally {
    opened?.close();
  }
}

function files() {
  const own = scene.bytes ?? new TextEncoder().encode(at("text").value);
  return [[scene.path, own], ...scene.others];
}

function number(id) {
  const { value, validity } = at(id);
  return value === "" || !validity.valid ? undefined : Number(value);
}

const KNOBS = ["supersampling", "samples", "depth"];

function settings() {
  const size = { width: number("width"), height: number("height") };
  return { ...size, ...Object.fromEntries(KNOBS.map((name) => [name, number(name)])) };
}

/** The line that renders the same. */
function command() {
  const { width, height, ...knobs } = settings();
  const flags = { supersampling: "--supersampling", samples: "--spp", depth: "--depth" };
  const size = width && height ? ` --size ${width}x${height}` : "";
  const rest = KNOBS.filter((name) => knobs[name] !== undefined).map((name) => ` ${flags[name]} ${knobs[name]}`);
  const picture = scene.path.replace(/\.\w+$/, ".png");
  return `rtc render ${scene.path}${size}${rest.join("")} -o ${picture} && sha256sum ${picture}`;
}

function render() {
  clearTimeout(resting);
  resting = null;
  at("status").textContent = "rendering …";
  document.body.classList.add("is-old");
  start(show);
}

function later() {
  clearTimeout(resting);
  document.body.classList.add("is-old");
  at("status").textContent = "waiting for the next key …";
  resting = setTimeout(render, REST);
}

function tell(findings) {
  const own = scene.bytes ? null : scene.path;
  showFindings(at("findings"), findings, { codes, path: own, field: at("text"), changed: render });
}

/** Lets a link save these bytes. */
function offer(id, name, bytes) {
  URL.revokeObjectURL(at(id).href);
  at(id).href = URL.createObjectURL(new Blob([bytes]));
  at(id).download = name;
}

const hex = (bytes) => [...new Uint8Array(bytes)].map((byte) => byte.toString(16).padStart(2, "0")).join("");

/** The findings and the effects of the scene at once; then its picture. */
async function show(opened, signal) {
  tell(await opened.check());
  const effects = await opened.effects(settings());
  const { width, height, rgba, png, seconds, rays, findings } = await opened.render(settings(), { signal });
  tell(findings);
  showEffects(at("effects"), effects);
  const canvas = at("picture");
  [canvas.width, canvas.height] = [width, height];
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(rgba.buffer), width, height), 0, 0);
  at("made").textContent = `${width} × ${height}, ${rays.toLocaleString("en")} rays in ${seconds.toFixed(2)} s`;
  const hash = hex(await crypto.subtle.digest("SHA-256", png));
  if (signal.aborted) return;
  offer("file", scene.path.replace(/\.\w+$/, ".png"), png);
  offer("source", ...files()[0]);
  at("command").textContent = command();
  at("hash").textContent = hash;
  at("same").hidden = false;
  document.body.classList.remove("is-old");
  at("status").textContent = "finished";
}

/** The pictures of two settings: how long each takes, and how far they are apart. */
async function compare(opened, signal, both) {
  const [a, b] = [await opened.render(both[0], { signal }), await opened.render(both[1], { signal })];
  let sum = 0;
  a.rgba.forEach((byte, index) => (sum += index % 4 === 3 ? 0 : (byte - b.rgba[index]) ** 2));
  const levels = Math.sqrt(sum / ((a.rgba.length / 4) * 3));
  const ratio = (b.seconds / a.seconds).toFixed(1);
  const times = `${a.seconds.toFixed(2)} s, with twice as many ${b.seconds.toFixed(2)} s: ${ratio} times as long`;
  at("costs").textContent = `${times}. The pictures differ by ${levels.toFixed(2)} of 255 grey levels (root mean square).`;
  at("status").textContent = "measured";
}

function failed({ message, findings = [] }) {
  tell(findings);
  at("same").hidden = true;
  at("status").textContent = findings.length > 0 ? "no picture: see the findings" : `no picture: ${message}`;
}

function open(path, text, others) {
  const isText = typeof text === "string";
  scene = { path, others, original: isText ? text : null, bytes: isText ? undefined : text };
  at("text").value = isText ? text : "";
  at("text").disabled = !isText;
  const names = others.map(([name]) => name).join(", ");
  const beside = names === "" ? "" : `Beside it: ${names}.`;
  at("files-note").textContent = isText ? beside : `${path} has no text to edit. ${beside}`;
  render();
}

async function openKnown(path) {
  const bytes = async (name) => [name, new Uint8Array(await (await fetch(`scenes/${name}`)).arrayBuffer())];
  const others = await Promise.all(known[path].map(bytes));
  at("scenes").value = path;
  open(path, await (await fetch(`scenes/${path}`)).text(), others);
}

async function openFiles(list) {
  const all = await Promise.all([...list].map(async (file) => [file.name, new Uint8Array(await file.arrayBuffer())]));
  const isScene = ([name]) => SCENE.test(name);
  const first = all.find(([name]) => /\.(ya?ml|gltf|glb)$/i.test(name)) ?? all.find(isScene) ?? all[0];
  if (!first) return;
  const others = all.filter((file) => file !== first);
  open(first[0], TEXT.test(first[0]) ? new TextDecoder().decode(first[1]) : first[1], others);
}

/** Opens what the address says: a scene of the list, a text, or else the first scene. */
async function openAddress() {
  const words = new URLSearchParams(location.hash.slice(1));
  const [name, text] = [`${words.get("scene")}.yaml`, words.get("text")];
  if (!text) return openKnown(name in known ? name : "camera.yaml");
  try {
    const [path, own] = JSON.parse(await unpacked(text));
    open(String(path), String(own), []);
  } catch {
    at("status").textContent = "the address holds no scene";
  }
}

async function share() {
  const { path, original } = scene;
  const text = at("text").value;
  const isKnown = path in known && text === original;
  const words = isKnown ? { scene: path.replace(".yaml", "") } : { text: await packed(JSON.stringify([path, text])) };
  history.replaceState(null, "", `#${new URLSearchParams(words)}`);
  await navigator.clipboard?.writeText(location.href).catch(() => undefined);
  const missing = !isKnown && scene.others.length > 0 ? "; the files beside the text are not in it" : "";
  at("status").textContent = `the address holds the scene${missing}`;
}

at("scenes").append(...Object.keys(known).map((path) => new Option(path.replace(".yaml", ""), path)));
at("scenes").addEventListener("change", ({ target }) => openKnown(target.value));
at("files").addEventListener("change", ({ target }) => openFiles(target.files));
at("share").addEventListener("click", share);
at("text").addEventListener("input", later);
at("settings").addEventListener("input", later);
at("settings").addEventListener("submit", (event) => event.preventDefault());
at("cost").addEventListener("submit", (event) => {
  event.preventDefault();
  const [knob, amount] = [at("knob").value, Number(at("amount").value)];
  at("costs").textContent = "measuring …";
  const both = [amount, 2 * amount].map((own) => ({ ...settings(), [knob]: own }));
  start((opened, signal) => compare(opened, signal, both));
});
addEventListener("hashchange", openAddress);
await openAddress();
