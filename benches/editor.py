"""Measures `rtc lsp`: the work of editor.sh.

python3 editor.py RTC
"""

import json
import pathlib
import subprocess
import sys

KEYSTROKES = 40
URI = "file:///tmp/typed.yaml"
HEAD = """Camera: {eye: [200, 200, 1000], center: [200, 200, 0], up: [0, 1, 0], viewSize: [400, 400]}
Lights:
- {position: [-200, 600, 1500], color: [1, 1, 1]}
Objects:
"""


def scene(objects):
    """A scene of spheres, and the line of the last one."""
    sphere = (
        "- {{type: sphere, position: [{0}, {1}, 0], radius: 3, "
        "material: {{color: [0.9, 0.4, 0.2], ka: 0.2, kd: 0.7, ks: 0.5, n: 64}}}}\n"
    )
    text = HEAD + "".join(sphere.format(at * 31 % 400, at // 13) for at in range(objects))
    return text, text.count("\n") - 1


class Editor:
    def __init__(self, rtc):
        self.server = subprocess.Popen([rtc, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.last = 0
        self.ask("initialize", {"capabilities": {}})
        self.note("initialized", {})

    def write(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.server.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self.server.stdin.flush()

    def read(self):
        length = int(self.server.stdout.readline().split()[1])
        while self.server.stdout.readline().strip():
            pass
        return json.loads(self.server.stdout.read(length))

    def until(self, is_wanted):
        while not is_wanted(message := self.read()):
            pass
        return message

    def note(self, method, params):
        self.write({"method": method, "params": params})

    def ask(self, method, params):
        self.last += 1
        self.write({"id": self.last, "method": method, "params": params})
        return self.until(lambda message: message.get("id") == self.last)

    def found(self):
        return self.until(
            lambda message: message.get("method") == "textDocument/publishDiagnostics"
        )

    def cpu(self):
        """Milliseconds of all threads since the start."""
        tasks = pathlib.Path(f"/proc/{self.server.pid}/task").iterdir()
        return sum(int((task / "schedstat").read_text().split()[0]) for task in tasks) / 1e6


def measured(rtc, objects):
    text, line = scene(objects)
    editor = Editor(rtc)
    document = {"uri": URI, "version": 1, "languageId": "yaml", "text": text}
    editor.note("textDocument/didOpen", {"textDocument": document})
    editor.found()
    findings, asked = 0, 0
    column = text.splitlines()[line].index("radius: 3") + len("radius: ")
    own = {"textDocument": {"uri": URI}}
    shown = {
        "start": {"line": max(0, line - 50), "character": 0},
        "end": {"line": line, "character": 0},
    }
    for stroke in range(KEYSTROKES):
        start = editor.cpu()
        place = {"line": line, "character": column}
        # A digit is typed, then taken away again.
        end = {"line": line, "character": column + stroke % 2}
        change = {"range": {"start": place, "end": end}, "text": "" if stroke % 2 else "1"}
        version = {"uri": URI, "version": stroke + 2}
        editor.note("textDocument/didChange", {"textDocument": version, "contentChanges": [change]})
        assert not (found := editor.found()["params"]["diagnostics"]), found[:3]
        middle = editor.cpu()
        for method in ("semanticTokens/range", "inlayHint"):
            editor.ask(f"textDocument/{method}", {**own, "range": shown})
        for method in ("foldingRange", "codeLens"):
            editor.ask(f"textDocument/{method}", own)
        end = editor.cpu()
        findings, asked = findings + middle - start, asked + end - middle
    editor.server.kill()
    return findings / KEYSTROKES, asked / KEYSTROKES


for objects in (100, 5000):
    findings, asked = measured(sys.argv[1], objects)
    print(
        f"{objects} objects: {findings:.1f} ms of CPU from a keystroke to its findings, "
        f"{asked:.1f} ms for tokens, hints, folds and lenses of the lines in view"
    )
