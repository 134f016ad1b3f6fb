// A conversation with `rtc lsp` by the protocol library of VS Code: what it finds in a scene, the fix of it, and
// all that an editor asks meanwhile. RTC names the binary [default: target/debug/rtc].

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import lsp from "vscode-languageserver-protocol/node.js";
import { TextDocument } from "vscode-languageserver-textdocument";

const SCENE = `# 😀 Three balls.
Camera: {eye: [0, 0, 50], center: [0, 0, 0], up: [0, 1, 0], viewSize: [12, 8]}
Shadws: true
Lights: [{position: [9, 9, 90], color: [1, 1, 1]}]
Objects:
- &ball {type: sphere, position: [0, 0, 0], radius: 3, material: {color: [1, 0.5, 0], ka: 0.2, kd: 0.7, ks: 0, n: 1}}
- *ball
`;
const GLTF = `{"asset": {"version": "2.0"}, "scene": 3, "scenes": [{"nodes": []}]}`;

const here = fileURLToPath(new URL(".", import.meta.url));
const rtc = process.env.RTC ?? join(here, "../../target/debug/rtc");
const folder = mkdtempSync(join(tmpdir(), "rtc-lsp-"));
writeFileSync(join(folder, "ball.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
const address = (name) => pathToFileURL(join(folder, name)).href;

const server = spawn(rtc, ["lsp"], { cwd: folder, stdio: ["pipe", "pipe", "inherit"] });
const ended = new Promise((done) => server.once("exit", done));
const connection = lsp.createProtocolConnection(
  new lsp.StreamMessageReader(server.stdout),
  new lsp.StreamMessageWriter(server.stdin),
);
const faults = [];
connection.onError(([error]) => faults.push(error));
const published = [];
const waiting = [];
connection.onNotification(lsp.PublishDiagnosticsNotification.type, (told) => {
  published.push(told);
  for (const look of waiting.splice(0)) look();
});
connection.listen();

/** What a version of a text was said to have. */
async function findings(uri, version) {
  for (;;) {
    const told = published.find((own) => own.uri === uri && own.version === version);
    if (told) return told.diagnostics;
    await new Promise((look) => waiting.push(look));
  }
}

const greeting = {
  processId: process.pid,
  rootUri: pathToFileURL(folder).href,
  capabilities: { textDocument: { codeAction: { codeActionLiteralSupport: { codeActionKind: { valueSet: ["quickfix"] } } } } },
};
const { capabilities } = await connection.sendRequest(lsp.InitializeRequest.type, greeting);
assert.ok(capabilities.hoverProvider && capabilities.completionProvider && capabilities.colorProvider);
await connection.sendNotification(lsp.InitializedNotification.type, {});

let text = TextDocument.create(address("balls.yaml"), "yaml", 1, SCENE);
const own = { uri: text.uri };
const at = (piece, after = 0) => text.positionAt(text.getText().indexOf(piece) + after);
await connection.sendNotification(lsp.DidOpenTextDocumentNotification.type, {
  textDocument: { ...own, languageId: "yaml", version: 1, text: SCENE },
});
const [slip] = (await findings(text.uri, 1)).filter((found) => found.code === "SC001");
assert.deepEqual(text.getText(slip.range), "Shadws");

const actions = await connection.sendRequest(lsp.CodeActionRequest.type, {
  textDocument: own,
  range: slip.range,
  context: { diagnostics: [slip] },
});
const fix = actions.find((action) => action.kind === "quickfix");
const edits = fix.edit.changes?.[text.uri] ?? fix.edit.documentChanges[0].edits;
const mended = TextDocument.applyEdits(text, edits);
assert.equal(mended, SCENE.replace("Shadws", "Shadows"));
text = TextDocument.update(text, [{ text: mended }], 2);
await connection.sendNotification(lsp.DidChangeTextDocumentNotification.type, {
  textDocument: { ...own, version: 2 },
  contentChanges: edits.map(({ range, newText }) => ({ range, text: newText })),
});
assert.deepEqual((await findings(text.uri, 2)).filter((found) => found.severity < 3), []);

const ask = (type, more) => connection.sendRequest(type, { textDocument: own, ...more });
const hover = await ask(lsp.HoverRequest.type, { position: at("Shadows", 2) });
assert.match(JSON.stringify(hover.contents), /shadow/i);
const place = await ask(lsp.HoverRequest.type, { position: at("eye", 1) });
assert.match(JSON.stringify(place.contents), /in scene units/);
const offered = [await ask(lsp.CompletionRequest.type, { position: at("Shadows") })].flatMap((own) => own.items ?? own);
const keys = offered.map((item) => item.label);
assert.ok(keys.includes("ToneMap") && !keys.includes("Lights"), `keys that are not there yet: ${keys}`);
const colors = await ask(lsp.DocumentColorRequest.type, {});
assert.deepEqual(colors.map(({ range }) => text.getText(range)), ["[1, 1, 1]", "[1, 0.5, 0]"]);
const symbols = await ask(lsp.DocumentSymbolRequest.type, {});
assert.ok(symbols.some((symbol) => symbol.name === "Objects" && symbol.children.length === 2));
const anchor = await ask(lsp.DefinitionRequest.type, { position: at("*ball", 2) });
assert.equal([anchor].flat()[0].range.start.line, 5);
const hints = await ask(lsp.InlayHintRequest.type, { range: { start: text.positionAt(0), end: text.positionAt(1e9) } });
assert.ok(hints.length > 0, "defaults");
const layout = await ask(lsp.DocumentFormattingRequest.type, { options: { tabSize: 2, insertSpaces: true } });
const laidOut = TextDocument.applyEdits(text, layout ?? []);
assert.match(laidOut, /^# 😀 Three balls\./);

await connection.sendNotification(lsp.DidOpenTextDocumentNotification.type, {
  textDocument: { uri: address("empty.gltf"), languageId: "json", version: 1, text: GLTF },
});
assert.ok((await findings(address("empty.gltf"), 1)).some((found) => found.severity === lsp.DiagnosticSeverity.Error));

const scene = { line: 0, character: GLTF.indexOf(": 3") + 2 };
const ofGltf = await connection.sendRequest(lsp.HoverRequest.type, { textDocument: { uri: address("empty.gltf") }, position: scene });
assert.match(JSON.stringify(ofGltf.contents), /The scene that is shown.*##/, "what the key means, and what is wrong with it");

await connection.sendRequest(lsp.ShutdownRequest.type);
await connection.sendNotification(lsp.ExitNotification.type);
assert.equal(await ended, 0);
assert.deepEqual(faults, []);
rmSync(folder, { recursive: true });
console.log(`all is well: ${capabilities.positionEncoding ?? "utf-16"}, ${published.length} lists of findings, ${hints.length} hints`);
