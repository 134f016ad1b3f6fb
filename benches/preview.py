"""Measures `rtc preview`: the work of preview.sh.

python3 preview.py RTC
"""

import http.client
import json
import os
import pathlib
import re
import resource
import socket
import statistics
import subprocess
import sys
import tempfile
import time

SAVES = 21
IDLE = 10.0
CONNECTIONS = 10_000


class Live:
    """A preview that runs."""

    def __init__(self, rtc, scene):
        self.process = subprocess.Popen(
            [rtc, "preview", str(scene)], stdout=subprocess.PIPE, text=True
        )
        address = self.process.stdout.readline().strip()
        self.port, self.token = re.match(
            r"http://127\.0\.0\.1:(\d+)/\?token=(\w+)", address
        ).groups()

    def get(self, path, more=""):
        connection = http.client.HTTPConnection("127.0.0.1", int(self.port), timeout=60)
        connection.request("GET", f"{path}?token={self.token}{more}")
        reply = connection.getresponse()
        return reply.status, reply.read()

    def when(self, is_wanted):
        connection = http.client.HTTPConnection("127.0.0.1", int(self.port), timeout=60)
        connection.request("GET", f"/events?token={self.token}")
        with connection.getresponse() as events:
            for line in events:
                if line.startswith(b"data: {") and is_wanted(state := json.loads(line[6:])):
                    return state

    def cpu(self):
        """Seconds of all cores since the start."""
        fields = (
            pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        )
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def saves(live, scene, text):
    """Milliseconds from each save to the first picture of it, and to the finished one."""
    first, whole = [], []
    state = live.when(lambda state: state["picture"] and state["picture"]["isFinished"])
    for turn in range(SAVES):
        load = state["load"]
        begun = time.monotonic()
        scene.write_text(text + f"# {turn}\n")
        state = live.when(lambda state: state["picture"]["load"] > load)
        live.get("/picture", f"&number={state['picture']['number']}")
        first.append(1000 * (time.monotonic() - begun))
        state = live.when(
            lambda state: state["picture"]["load"] > load and state["picture"]["isFinished"]
        )
        whole.append(1000 * (time.monotonic() - begun))
        time.sleep(0.2)
    return first, whole


def crowd(live):
    """How many connections were opened, and whether a page is served after them."""
    limit = resource.getrlimit(resource.RLIMIT_NOFILE)[0] - 100
    opened, held = 0, []
    while opened < CONNECTIONS:
        try:
            one = socket.create_connection(("127.0.0.1", int(live.port)), timeout=5)
            one.sendall(b"GET / HTTP/1.1\r\n")
            held.append(one)
            opened += 1
        except OSError:
            held.clear()
        if len(held) > limit:
            held.clear()
    stranger = http.client.HTTPConnection("127.0.0.1", int(live.port), timeout=60)
    stranger.request("GET", "/")
    refused = stranger.getresponse().status
    held.clear()
    return opened, refused, live.get("/")[0]


def main(rtc):
    text = pathlib.Path("scenes/camera.yaml").read_text()
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "camera.yaml"
        scene.write_text(text)
        live = Live(rtc, scene)
        first, whole = saves(live, scene, text)
        told = [
            f"{statistics.median(times):.0f} ms (worst {max(times):.0f})"
            for times in (first, whole)
        ]
        print(
            f"from a save to the first picture {told[0]}, to the finished one {told[1]}; medians "
            f"of {SAVES}"
        )
        time.sleep(1)
        before = live.cpu()
        time.sleep(IDLE)
        print(f"idle: {100 * (live.cpu() - before) / IDLE:.2f} % of a core")
        opened, refused, served = crowd(live)
        print(
            f"{opened} connections that ask for half a page: a stranger is told {refused}, the "
            f"page {served}"
        )
        live.process.terminate()
        live.process.wait()


main(*sys.argv[1:])
