// Puts the scenes of the repository into dist/, each with the files that it names, and what `rtc explain` says of each code.
import { copyFileSync, readFileSync, readdirSync, writeFileSync } from "node:fs";

const scenes = new URL("../../scenes/", import.meta.url);
const dist = new URL("dist/", import.meta.url);
const names = readdirSync(scenes);
const isAsset = (name) => /\.(obj|png|glb)$/.test(name);

const list = {};
for (const name of names.filter((name) => name.endsWith(".yaml"))) {
  const text = readFileSync(new URL(name, scenes), "utf8");
  list[name] = names.filter((other) => isAsset(other) && text.includes(other));
  for (const file of [name, ...list[name]]) copyFileSync(new URL(file, scenes), new URL(`scenes/${file}`, dist));
}
writeFileSync(new URL("scenes.json", dist), JSON.stringify(list));

const page = readFileSync(new URL("../../schema/diagnostics.md", import.meta.url), "utf8");
const codes = {};
for (const [, code, , title, text] of page.matchAll(/^## ([A-Z]+\d+) \((\w+)\): (.*)\n\n([^]*?)(?=\n## |$(?![^]))/gm)) {
  codes[code] = { title, text: text.trim() };
}
writeFileSync(new URL("codes.json", dist), JSON.stringify(codes));
