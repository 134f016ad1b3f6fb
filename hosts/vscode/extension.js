// Scenes in VS Code: `rtc lsp` finds and mends while one types, `rtc preview` shows the picture beside the text.

const { spawn } = require("node:child_process");
const { dirname, basename } = require("node:path");
const { createInterface } = require("node:readline");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

/** The files that scenes name: when one changes, its scenes are checked again. */
const WATCHED = "**/{rtc.toml,*.{yaml,yml,json,gltf,glb,bin,obj,mtl,ply,stl,off,png,jpg,jpeg,webp,hdr,exr,ies}}";

/** How much of what a program says to its end is kept for the reader, in characters. */
const KEPT = 4000;

/** @type {LanguageClient | undefined} */
let client;

/** The previews that are open, by the paths of their scenes. */
const previews = new Map();

function settings(uri) {
  const all = vscode.workspace.getConfiguration("rtc", uri);
  return { path: all.get("path"), words: all.get("arguments"), scenes: all.get("scenes") };
}

async function startServer() {
  const { path, words, scenes } = settings();
  const watcher = vscode.workspace.createFileSystemWatcher(WATCHED);
  client = new LanguageClient(
    "rtc",
    "rtc",
    { command: path, args: ["lsp", ...words] },
    {
      documentSelector: scenes.map((pattern) => ({ scheme: "file", pattern })),
      synchronize: { fileEvents: watcher },
    },
  );
  try {
    await client.start();
  } catch (error) {
    watcher.dispose();
    client = undefined;
    await tellMissing(path, error);
  }
}

async function stopServer() {
  const old = client;
  client = undefined;
  await old?.stop();
}

async function tellMissing(path, error) {
  const open = "Open Settings";
  const words = `rtc does not start as \`${path}\`: ${error.message ?? error}. \`cargo install\` brings it, or name it in rtc.path.`;
  if ((await vscode.window.showErrorMessage(words, open)) === open) {
    await vscode.commands.executeCommand("workbench.action.openSettings", "rtc.path");
  }
}

/** The picture of a scene in a panel beside; the program ends with the panel. */
function preview(wanted) {
  const uri = wanted ?? vscode.window.activeTextEditor?.document.uri;
  if (uri?.scheme !== "file") {
    return vscode.window.showInformationMessage("Open a scene that is a file on disk first.");
  }
  const shown = previews.get(uri.fsPath);
  if (shown) return shown.reveal(undefined, true);
  const { path, words } = settings(uri);
  const name = basename(uri.fsPath);
  const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
  const panel = vscode.window.createWebviewPanel("rtc.preview", `Picture of ${name}`, place, {
    enableScripts: true,
    retainContextWhenHidden: true,
  });
  previews.set(uri.fsPath, panel);
  const program = spawn(path, ["preview", ...words, uri.fsPath], { cwd: dirname(uri.fsPath) });
  let isClosed = false;
  let said = "";
  program.stderr.on("data", (text) => (said = (said + text).slice(-KEPT)));
  createInterface({ input: program.stdout }).once("line", async (address) => {
    const inside = vscode.Uri.parse(address, true);
    const outside = await vscode.env.asExternalUri(inside);
    // Some editors keep nothing but the host and the port.
    const { path, query } = inside;
    if (!isClosed) panel.webview.html = page(outside.with({ path, query }).toString(true));
  });
  program.on("error", (error) => {
    panel.dispose();
    tellMissing(path, error);
  });
  program.on("exit", () => {
    if (!isClosed) panel.webview.html = letter(`rtc preview has ended.\n\n${said}`);
  });
  panel.onDidDispose(() => {
    isClosed = true;
    previews.delete(uri.fsPath);
    program.kill("SIGINT");
  });
}

const escaped = (text) => text.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);

/** A page that holds that of `rtc preview`. */
function page(address) {
  const { origin } = new URL(address);
  return `<!doctype html><html lang="en"><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; frame-src ${origin}; style-src 'unsafe-inline'">
<style>html,body,iframe{margin:0;padding:0;border:0;width:100%;height:100%;display:block;overflow:hidden}</style>
<iframe title="Picture" src="${escaped(address)}"></iframe></html>`;
}

/** A page that says something. */
function letter(text) {
  return `<!doctype html><html lang="en"><meta charset="utf-8"><pre>${escaped(text)}</pre></html>`;
}

exports.activate = async (context) => {
  const restart = async () => {
    await stopServer();
    await startServer();
  };
  context.subscriptions.push(
    vscode.commands.registerCommand("rtc.preview", preview),
    vscode.commands.registerCommand("rtc.restart", restart),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("rtc")) return restart();
    }),
  );
  await startServer();
};

exports.deactivate = async () => {
  for (const panel of previews.values()) panel.dispose();
  await stopServer();
};
