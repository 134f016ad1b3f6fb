// What is said of a scene, as the page shows it: findings with their fixes, and effects with their verdicts.

function element(name, text = "", more = {}) {
  return Object.assign(document.createElement(name), { textContent: text, ...more });
}

/** Places of the library are bytes of UTF-8, those of a field letters. */
function letters(text, byte) {
  return new TextDecoder().decode(new TextEncoder().encode(text).subarray(0, byte)).length;
}

function mend({ field, changed }, { start, end, text }) {
  const own = field.value;
  field.value = own.slice(0, letters(own, start)) + text + own.slice(letters(own, end));
  changed();
}

function goTo(field, { start, end }) {
  field.focus();
  field.setSelectionRange(letters(field.value, start), letters(field.value, end));
}

function shownFinding(finding, page) {
  const item = element("div", "", { className: `finding ${finding.severity}` });
  item.append(element("pre", finding.text, { tabIndex: 0 }));
  const row = element("div", "", { className: "row" });
  const isOwn = (place) => page.path !== null && place?.file === page.path;
  for (const { replacement } of finding.hints.filter((hint) => isOwn(hint.replacement))) {
    const words = replacement.text === "" ? "Take it out" : `Put \`${replacement.text}\``;
    row.append(element("button", words, { type: "button", onclick: () => mend(page, replacement) }));
  }
  if (isOwn(finding.place)) {
    const show = () => goTo(page.field, finding.place);
    row.append(element("button", "Show the place", { type: "button", onclick: show }));
  }
  item.append(row);
  const code = page.codes[finding.code];
  if (code) {
    const details = element("details");
    details.append(element("summary", `${finding.code}: ${code.title}`), element("p", code.text));
    item.append(details);
  }
  return item;
}

/** `page` has the codes, the path of the text or null, the field of it, and what is done when it has changed. */
export function showFindings(place, findings, page) {
  const none = [element("p", "None.", { className: "hint" })];
  place.replaceChildren(...(findings.length > 0 ? findings.map((own) => shownFinding(own, page)) : none));
}

export function showEffects(body, effects) {
  const row = ({ name, of, state, rule, because }) => {
    const line = element("tr");
    const verdict = rule ? `${state} (${rule})` : state;
    line.append(element("td", of ? `${name}, ${of}` : name), element("td", verdict), element("td", because));
    return line;
  };
  body.replaceChildren(...effects.map(row));
}
