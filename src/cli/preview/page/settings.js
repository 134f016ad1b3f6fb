// The panel of settings: what the scene has, what each costs, and choosing one.

// As the panel was made last: anew only for others, so that what has the focus keeps it.
let madeKnobs = "";
let madeRows = "";

// The reading of the scene, the manner of it and the settings, of which costs are being measured.
let measured = null;

const looked = () => JSON.stringify([state.load, state.view, state.choice]);

function showSettings() {
  const { settings, costs } = state;
  if (settings !== null) {
    const made = JSON.stringify([state.load, settings]);
    if (made !== madeKnobs) makeKnobs(settings);
    madeKnobs = made;
    for (const own of at("knobs").querySelectorAll("[data-knob]")) {
      if (own !== document.activeElement) own.value = valueOf(own.dataset.knob);
    }
  }
  const made = JSON.stringify(costs);
  if (made !== madeRows) makeRows(costs);
  madeRows = made;
  for (const own of at("rows").querySelectorAll("button")) {
    own.setAttribute("aria-pressed", String(own.dataset.values === ordered(state.choice.values)));
  }
  if (costs !== null || measured !== looked()) measured = null;
  at("measure").disabled = measured !== null;
  at("measuring").textContent = measured === null ? "It takes some seconds; a change ends it." : "measuring …";
}

const ordered = (values) => JSON.stringify(Object.entries(values).sort());
const isChosen = () => Object.keys(state.choice.values).length > 0 || state.choice.integrator !== null;

function valueOf(knob) {
  const { settings, choice } = state;
  if (knob === "integrator") return choice.integrator ?? settings.integrator;
  return choice.values[knob] ?? settings.knobs.find((own) => own.knob === knob).own;
}

function make(kind, words, more = {}) {
  return Object.assign(document.createElement(kind), { textContent: words }, more);
}

// A line for each setting that the scene has, and the reasons for those that it has not.
function makeKnobs({ knobs, integrator }) {
  const used = knobs.filter((own) => own.idle === null);
  const lines = used.map(({ knob, name, own, words, lowest }) => {
    const input = words === null ? number(lowest) : select(words.map((word, value) => [value, word]));
    return line(knob, name, input, words === null ? own : words[own]);
  });
  if (integrator !== null) {
    const input = select([["whitted", "mirrors and glass alone"], ["path", "all ways of light"]]);
    lines.push(line("integrator", "light by", input, null));
  }
  at("knobs").replaceChildren(...lines);
  const idle = knobs.filter((own) => own.idle !== null);
  at("idle").textContent = idle.map((own) => `${own.name}: ${own.idle}`).join("; ");
}

const number = (lowest) => make("input", "", { type: "number", min: lowest, step: 1, inputMode: "numeric" });

function select(options) {
  const own = document.createElement("select");
  own.append(...options.map(([value, words]) => make("option", words, { value })));
  return own;
}

function line(knob, name, input, own) {
  const row = make("div", "", { className: "row" });
  input.id = `knob-${knob}`;
  input.dataset.knob = knob;
  input.addEventListener("change", () => set(knob, input.value));
  const hint = own === null ? "" : `the scene's own: ${own}`;
  row.append(make("label", name, { htmlFor: input.id }), input, make("span", hint, { className: "hint" }));
  return row;
}

// Has one setting at a value; at its own, nothing is said of it.
function set(knob, value) {
  const { values, integrator } = structuredClone(state.choice);
  if (knob === "integrator") {
    // What was measured, and chosen, is of the other one.
    return choose({ values: {}, integrator: value });
  }
  const own = state.settings.knobs.find((one) => one.knob === knob);
  const wanted = Math.round(Number(value));
  if (value === "" || wanted < own.lowest || wanted === own.own) delete values[knob];
  else values[knob] = wanted;
  return choose({ values, integrator });
}

async function choose(choice) {
  const reply = await send("/settings", choice);
  at("said").textContent = reply.ok ? "" : "there is no such setting";
}

function makeRows(costs) {
  at("priced").hidden = costs === null;
  at("costs").textContent = costs?.report ?? "";
  at("advice").textContent = costs?.advice[0] ?? "";
  const rows = costs?.rows ?? [];
  // What is dearer and worse than another is for those who want it all.
  const isShown = ({ isFront, isBest, values }) =>
    at("every").checked || isFront || isBest || Object.keys(values).length === 0;
  const shown = rows.filter(isShown);
  at("rows").replaceChildren(...shown.map(priced));
  at("every").parentElement.hidden = !at("every").checked && shown.length === rows.length;
}

// A setting with what it takes and its error, and a button that has the picture in it.
function priced({ values, words, seconds, ratio, error, most, isJudged, isFront, isBest }) {
  const row = document.createElement("tr");
  const own = make("button", "use", { type: "button" });
  own.setAttribute("aria-label", `use ${words}`);
  own.dataset.values = ordered(values);
  const { integrator } = state.choice;
  own.addEventListener("click", () => choose({ values, integrator }));
  const marks = [isBest && "recommended", Object.keys(values).length === 0 && "the scene's own"].filter(Boolean);
  const name = make("th", words, { scope: "row" });
  if (marks.length > 0) name.append(make("small", marks.join(", ")));
  row.className = isFront ? "front" : "";
  const spread = most > error ? ` … ${digits(most)}` : "";
  const cells = [`${isJudged ? "" : "≤ "}${digits(error)}${spread}`, time(seconds), `${digits(ratio)} ×`];
  const last = document.createElement("td");
  last.append(own);
  row.append(name, ...cells.map((cell) => make("td", cell)), last);
  return row;
}

const digits = (value) => (value === 0 ? "0" : value >= 100 ? value.toFixed(0) : value.toPrecision(2));
const time = (seconds) => (seconds < 0.1 ? `${digits(1000 * seconds)} ms` : `${digits(seconds)} s`);

function measure() {
  if (measured !== null) return;
  measured = looked();
  send("/costs", null);
  showSettings();
}

function listenToSettings() {
  at("measure").addEventListener("click", measure);
  at("prices").addEventListener("toggle", () => {
    if (at("prices").open && state?.costs === null) measure();
  });
  at("every").addEventListener("change", () => {
    madeRows = "";
    showSettings();
  });
  at("own").addEventListener("click", () => choose({ values: {}, integrator: null }));
}
