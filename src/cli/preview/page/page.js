// The page: asks for what is new, shows it, and sends what is done with it.

const token = new URLSearchParams(location.search).get("token") ?? "";
const at = (id) => document.getElementById(id);
const url = (path, more = {}) => `${path}?${new URLSearchParams({ token, ...more })}`;
const REST = 250;

let state = null;
let gaze = null;
let resting = null;
let drawn = 0;

let news = null;

// What is new, as it comes. Few pages are told at a time: one that gave way asks again when it is looked at.
function follow() {
  news?.close();
  news = new EventSource(url("/events"));
  news.onmessage = (event) => {
    state = JSON.parse(event.data);
    show();
  };
  news.addEventListener("full", () => lose("newer pages are told what is new; look at this one again to follow"));
  news.onerror = () => {
    lose("the preview does not answer; was it ended?");
    setTimeout(follow, 1000);
  };
}

function lose(words) {
  news.close();
  document.body.classList.remove("is-working");
  at("status").textContent = words;
}

function show() {
  document.body.classList.toggle("is-working", state.isWorking);
  at("status").textContent = words();
  showFindings();
  if (state.view && resting === null) {
    const { eye, center, up } = state.view;
    gaze = { eye, center, up };
  }
  at("moved").hidden = !state.isMoved && !isChosen();
  at("keep").hidden = !state.isMoved || !state.view?.canWrite;
  at("reset").hidden = !state.isMoved;
  at("own").hidden = !isChosen();
  at("command").value = state.command;
  if (state.effects !== null) at("verdicts").textContent = state.effects;
  showSettings();
  showPixel();
  if (state.picture && state.picture.number !== drawn) draw(state.picture);
  if (state.against && state.against.number !== laid) lay(state.against);
  showNoise();
}

function words() {
  const count = state.findings.length;
  const found = count === 0 ? "" : count === 1 ? ", 1 finding" : `, ${count} findings`;
  if (state.isWorking) return `rendering …${found}`;
  if (state.isFailed) return `no picture${found}`;
  const [width, height] = state.picture?.full ?? [0, 0];
  return `${width} × ${height}, finished${found}`;
}

async function draw({ number, full, isFinished }) {
  drawn = number;
  const bitmap = await fetched("/picture", number);
  if (bitmap === null || drawn !== number) return;
  at("frame").style.setProperty("--aspect", full[0] / full[1]);
  paint(at("picture"), bitmap);
  at("picture").dataset.number = number;
  if (isFinished && inspected !== null) inspect();
}

// What the picture is compared with.
let laid = 0;

async function lay({ number }) {
  laid = number;
  const bitmap = await fetched("/against", number);
  if (bitmap === null || laid !== number) return;
  paint(at("against"), bitmap);
  at("against").dataset.number = number;
  at("against").hidden = false;
  at("compare").hidden = false;
}

// The noise of the picture: the layer and the picture's number that are laid over it, or asked for.
let noise = "";
let asked = 0;

async function showNoise() {
  const layer = at("layer").value;
  const number = state.picture?.number;
  const isReady = layer !== "" && state.noise !== null && state.picture?.isFinished;
  at("bound").textContent = layer === "" ? "" : state.noise ?? "measuring the noise …";
  if (!isReady) {
    at("noise").hidden = true;
    noise = "";
    if (layer !== "" && state.picture?.isFinished && asked !== number) {
      asked = number;
      send("/noise", null);
    }
    return;
  }
  const wanted = `${layer} ${number}`;
  if (noise === wanted) return;
  noise = wanted;
  const bitmap = await fetched("/noise", number, { layer });
  if (noise !== wanted) return;
  at("noise").hidden = bitmap === null;
  if (bitmap !== null) paint(at("noise"), bitmap);
}

// The picture of this number; none if there is a newer one by now.
async function fetched(path, number, more = {}) {
  const reply = await fetch(url(path, { number, ...more }));
  return reply.ok ? createImageBitmap(await reply.blob()) : null;
}

function paint(canvas, bitmap) {
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  canvas.getContext("2d").drawImage(bitmap, 0, 0);
}

function showFindings() {
  at("overlay").hidden = !state.isFailed;
  at("warnings").hidden = state.isFailed || state.findings.length === 0;
  const blocks = state.findings.map(block);
  if (state.fault !== null) blocks.unshift(block({ texts: [state.fault], fix: null, change: "" }));
  if (state.findings.filter((one) => one.fix === "sure").length > 1) blocks.push(fixAll());
  at("errors").replaceChildren(...(state.isFailed ? blocks : []));
  at("notes").replaceChildren(...(state.isFailed ? [] : blocks));
}

// The columns of a text in this part of the page.
function columns(own) {
  const pen = document.createElement("canvas").getContext("2d");
  pen.font = "12.5px ui-monospace, monospace";
  return (own.clientWidth - 20) / pen.measureText("m").width;
}

// The widest text that fits, so that its marks stay under what they mark.
function fitting(texts) {
  const room = columns(at(state.isFailed ? "errors" : "notes"));
  const hasMark = (line) => /^\s*\| +[\^_-]/.test(line ?? "");
  const isFitting = (own) =>
    own.split("\n").every((line, k, lines) => line.length <= room || !(hasMark(line) || hasMark(lines[k + 1])));
  return (texts.find(isFitting) ?? texts.at(-1)).trimEnd();
}

function block({ texts, fix, change }, index) {
  const finding = document.createElement("div");
  finding.className = "finding";
  const source = document.createElement("pre");
  const text = fitting(texts);
  source.textContent = text;
  source.tabIndex = 0;
  finding.append(source);
  if (fix !== null) {
    const [title] = text.split("\n", 1);
    const label = change || "fix";
    finding.append(button(fix === "sure" ? label : `${label} (a guess)`, title, index));
  }
  return finding;
}

function fixAll() {
  const row = document.createElement("div");
  row.className = "row";
  row.append(button("fix all that is sure", "all findings", null));
  return row;
}

function button(label, title, finding) {
  const own = document.createElement("button");
  own.type = "button";
  own.textContent = label;
  own.setAttribute("aria-label", `${label}: ${title}`);
  own.dataset.fix = finding ?? "all";
  const { load } = state;
  own.addEventListener("click", () => act(own, "/fix", { load, finding }));
  return own;
}

function send(path, body) {
  return fetch(url(path), { method: "POST", body: JSON.stringify(body) });
}

// Has something done, and says so if it was not.
async function act(own, path, body) {
  own.disabled = true;
  const reply = await send(path, body);
  own.disabled = false;
  at("said").textContent = reply.ok ? "" : (await reply.text()) || "that was refused";
}

let sending = false;
let waiting = null;

// Sends a view; while one is on its way, only the last of the others.
async function look(order) {
  waiting = order;
  if (sending) return;
  sending = true;
  while (waiting !== null) {
    const next = waiting;
    waiting = null;
    await send("/view", next).catch(() => {});
  }
  sending = false;
}

function move(next) {
  gaze = next;
  clearTimeout(resting);
  look({ view: gaze, isMoving: true });
  resting = setTimeout(() => {
    resting = null;
    look({ view: gaze, isMoving: false });
  }, REST);
}

function reset() {
  clearTimeout(resting);
  resting = null;
  look({ view: null, isMoving: false });
}

const TURN = Math.PI / 24;
const STEP = 0.05;
const KEYS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

function onKey(event) {
  if (gaze === null || event.ctrlKey || event.metaKey || event.altKey) return;
  const way = KEYS[event.key];
  if (way && event.shiftKey) move(panned(gaze, way[0] * STEP, way[1] * STEP));
  else if (way) move(orbited(gaze, state.view.axis, way[0] * TURN, way[1] * TURN));
  else if (event.key === "+" || event.key === "=") move(zoomed(gaze, 1 / 1.1));
  else if (event.key === "-") move(zoomed(gaze, 1.1));
  else if (event.key === "0") reset();
  else return;
  event.preventDefault();
}

// The pixel that is looked at, and what is said of it.
let inspected = null;
let seen = "";
// Its surface in the text, as `file:line`; empty if it has no place there.
let place = "";

async function inspect() {
  const [x, y] = ["x", "y"].map((id) => Number(at(id).value));
  inspected = [x, y];
  const reply = await fetch(url("/pixel", { x, y }));
  if (!reply.ok) {
    seen = "there is no such pixel, or the picture is not finished";
    place = "";
    return showPixel();
  }
  const found = await reply.json();
  const value = found.value.map((v) => v.toPrecision(4)).join(", ");
  place = found.place ?? "";
  const named = [found.name, found.line && `(${found.line})`].filter(Boolean).join(" ");
  const surface =
    found.surface === null
      ? "no surface"
      : `surface ${found.surface}${named && `: ${named}`}, distance ${found.depth.toPrecision(5)}`;
  seen = `${x}, ${y}: value ${value}; ${surface}`;
  showPixel();
  send("/pixel", inspected);
}

function showPixel() {
  if (inspected === null) return;
  at("pixel").textContent = seen;
  at("place").hidden = place === "";
  const isOfIt = state.pixel !== null && String(state.pixel.at) === String(inspected);
  const parts = isOfIt ? state.pixel.effects.map(([name, count]) => `${name} ${count}×`) : [];
  at("taken").textContent = isOfIt ? `took part: ${parts.join(", ") || "what is behind the scene alone"}` : "";
}

function listen() {
  const picture = at("picture");
  picture.addEventListener("keydown", onKey);
  listenToPointers(picture);
  const onWheel = (event) => {
    event.preventDefault();
    if (gaze !== null) move(zoomed(gaze, Math.exp(Math.sign(event.deltaY) * 0.1)));
  };
  picture.addEventListener("wheel", onWheel, { passive: false });
  at("reset").addEventListener("click", reset);
  at("keep").addEventListener("click", () => act(at("keep"), "/keep", null));
  at("save").addEventListener("click", () => {
    const link = document.createElement("a");
    link.download = `${document.title.split(" – ")[0].replace(/\.[^.]*$/, "")}.png`;
    at("picture").toBlob((file) => {
      link.href = URL.createObjectURL(file);
      link.click();
      URL.revokeObjectURL(link.href);
    });
  });
  at("place").addEventListener("click", () => navigator.clipboard?.writeText(place).catch(() => {}));
  at("copy").addEventListener("click", () => {
    at("command").select();
    navigator.clipboard?.writeText(at("command").value).catch(() => {});
  });
  for (const id of ["x", "y"]) at(id).addEventListener("change", inspect);
  at("layer").addEventListener("change", showNoise);
  at("split").addEventListener("input", () => {
    at("frame").style.setProperty("--split", `${at("split").value}%`);
  });
  listenToSettings();
  addEventListener("resize", () => {
    if (state !== null) showFindings();
  });
  addEventListener("focus", () => {
    if (news?.readyState === EventSource.CLOSED) follow();
  });
  at("effects").addEventListener("toggle", () => {
    if (at("effects").open) send("/effects", null);
  });
}

