"""Scenes: read, checked, rendered, studied."""

from __future__ import annotations

import json
import os
import tempfile
import time as clock
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Sequence

from . import _rtc
from ._pictures import Image
from ._program import ask

SceneError = _rtc.SceneError
SceneError.findings = property(
    lambda error: [Finding(**found) for found in getattr(error, "_findings", [])],
    doc="What was found in the scene, as a list of Finding; empty if it is not about the scene.",
)


@dataclass(frozen=True)
class Finding:
    """One finding about a scene. As a string it is the text with the source, as `rtc check` prints it."""

    code: str
    severity: str
    message: str
    file: str | None
    line: int | None
    column: int | None
    hints: list[str]
    text: str

    def __str__(self) -> str:
        return self.text


class Rows(list):
    """The rows of a study: a list of dictionaries; `study` is the whole report."""

    def __init__(self, study: dict[str, Any]):
        super().__init__(study["rows"])
        self.study = study

    def to_pandas(self) -> Any:
        """The rows as a DataFrame, if pandas is there."""
        import pandas

        return pandas.json_normalize(list(self))


def load(
    source: str | os.PathLike[str] | bytes,
    *,
    name: str | None = None,
    files: Mapping[str, bytes] | None = None,
    strict: bool = False,
    lenient: bool = False,
    asset_root: str | os.PathLike[str] | None = None,
    time: float | None = None,
    animation: str | None = None,
    variant: str | None = None,
    camera: str | int | None = None,
) -> Scene:
    """Reads a scene.

    `source` is the path of a file (course YAML or JSON, glTF, a mesh, the IR), or the scene itself: text
    with more than one line, or bytes. A scene in memory is called `name`, and may name `files` beside it.
    Mistakes in it are findings of `Scene.check`.
    Raises SceneError if it can't be read.
    """
    reading = {
        "strict": strict,
        "lenient": lenient,
        "asset_root": None if asset_root is None else os.fspath(asset_root),
        "time": time,
        "animation": animation,
        "variant": variant,
        "camera": None if camera is None else str(camera),
    }
    if isinstance(source, str) and "\n" in source:
        source = source.encode()
    if isinstance(source, (bytes, bytearray, memoryview)):
        name = name or _name(bytes(source))
        held = {**{key: bytes(value) for key, value in (files or {}).items()}, name: bytes(source)}
        return Scene(_rtc.Scene.of_files(name, held, reading), held, name, reading)
    if files is not None or name is not None:
        raise TypeError("`name` and `files` are for scenes in memory")
    path = Path(source)
    return Scene(_rtc.Scene.open(path, reading), None, str(path), reading)


def _name(source: bytes) -> str:
    """What a scene in memory is called: its kind is told by its content, but for texts."""
    if source.startswith(b"glTF"):
        return "scene.glb"
    if source.startswith(b"\x89RTI"):
        return "scene.rtir"
    if source.startswith(b"ply"):
        return "scene.ply"
    return "scene.json" if source.lstrip()[:1] == b"{" else "scene.yaml"


class Scene:
    """A scene that was read; `load` makes it."""

    def __init__(self, held: Any, files: dict[str, bytes] | None, name: str, reading: dict[str, Any]):
        self._held, self._files, self._name, self._reading = held, files, name, reading

    def __repr__(self) -> str:
        return f"<rtc.Scene {self._name}>"

    def check(self) -> list[Finding]:
        """All that is to be said of it; a scene with errors has no picture."""
        return [Finding(**found) for found in self._held.check()]

    def render(
        self,
        size: tuple[int, int] | int | None = None,
        spp: int | None = None,
        *,
        supersampling: int | None = None,
        depth: int | None = None,
        settings: Mapping[str, Any] | None = None,
        target_error: float | None = None,
        aovs: Sequence[str] = (),
        format: str = "png",
        threads: int = 0,
        max_rays: int | None = None,
        exposure: float | None = None,
        tonemap: str | None = None,
        transparent: bool = False,
        orbit: tuple[float, float] | None = None,
    ) -> Image:
        """Renders its picture; what is not said is as the scene says, or as `rtc render` does.

        `size` is width and height, one number being both; `spp` are paths a pixel of scenes whose paths are
        traced, `supersampling` sub-samples along each side of a pixel of others; `settings` sets any setting of
        the IR by its name, as `{"lightSamples": 4}`. With `target_error`, in grey
        levels of 8 bits, samples are taken until the picture is that good. `aovs` are layers: albedo, normal,
        depth, uv, instance, position. `format` is png or png16 (values as displayed), exr or exr16 (linear).
        Ctrl-C ends it with KeyboardInterrupt; other threads of Python run meanwhile.
        Raises SceneError if the scene has errors, or can't be rendered so.
        """
        words = {
            "format": format,
            "size": (size, size) if isinstance(size, int) else size,
            "spp": spp,
            "supersampling": supersampling,
            "depth": depth,
            "settings": {name: json.dumps(value) for name, value in (settings or {}).items()},
            "target_error": target_error,
            "threads": threads,
            "max_rays": max_rays,
            "exposure": exposure,
            "tonemap": tonemap,
            "transparent": transparent,
            "orbit": orbit,
            "aovs": list(aovs),
        }
        begun = clock.perf_counter()
        made = self._held.render(words)
        return Image(made, clock.perf_counter() - begun, list(aovs), format)

    def cost(self, effort: str = "quick") -> Rows:
        """What accuracy costs in time, as `rtc cost` measures it in a process of its own.

        A ValueError tells what `rtc` says where there is no study.
        """
        words = ["cost", "--format", "json", "--effort", effort, *self._reading_words()]
        if self._files is None:
            return Rows(json.loads(ask([*words, "--", self._name])))
        with tempfile.TemporaryDirectory() as folder:
            for name, content in self._files.items():
                path = Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
            return Rows(json.loads(ask([*words, "--", str(Path(folder, self._name))])))

    def _reading_words(self) -> list[str]:
        words = []
        for key, value in self._reading.items():
            flag = "--" + key.replace("_", "-")
            if value is True:
                words.append(flag)
            elif value not in (None, False):
                words += [flag, str(value)]
        return words
