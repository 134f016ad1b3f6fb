"""Scenes: read, checked, rendered, studied."""

from __future__ import annotations

import errno
import json
import os
import sys
import time as clock
from dataclasses import dataclass
from operator import index
from pathlib import Path
from typing import TYPE_CHECKING, Callable, Dict, Iterable, List, Mapping, NoReturn, Optional, Sequence, SupportsIndex, Tuple, Union

import numpy as np

from . import _rtc
from ._builder import Camera, Light, Material, Object
from ._pictures import Image
from ._values import Json, plain

if TYPE_CHECKING:
    import pandas
    from tqdm.auto import tqdm

Progress = Union[bool, Callable[[float], object]]

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
    hints: List[str]
    text: str
    path: str | None = None

    def __str__(self) -> str:
        return self.text


class Rows(List[Dict[str, Json]]):
    """The rows of a study: a list of dictionaries; `study` is the whole report."""

    def __init__(self, study: Dict[str, Json], rows: Iterable[Dict[str, Json]]):
        super().__init__(rows)
        self.study = study

    def to_pandas(self) -> pandas.DataFrame:
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
    Raises FileNotFoundError if there is no such file, and SceneError if it can't be read.
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
        return Scene(_rtc.Scene.of_files(name, held, reading), name)
    if files is not None or name is not None:
        raise TypeError("`name` and `files` are for scenes in memory")
    path = Path(source)
    if not path.exists():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(path))
    return Scene(_rtc.Scene.open(path, reading), str(path))


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
    """A scene; `load` reads one, `SceneBuilder` builds one.

    `camera`, `lights` and `materials` can be read and set; what is not valid raises SceneError and changes nothing.
    """

    def __init__(self, held: _rtc.Scene, name: str):
        self._held, self._name = held, name

    def __repr__(self) -> str:
        return f"<rtc.Scene {self._name}>"

    def copy(self) -> Scene:
        """A copy, which can be changed by itself."""
        return Scene(self._held.copy(), self._name)

    @property
    def camera(self) -> Camera:
        """The camera; `dataclasses.replace(scene.camera, eye=…)` makes another. One that is orthographic has no `fov`."""
        camera = self._held.camera()
        if camera is None:
            raise SceneError("the scene cannot be read")
        return Camera._of(camera)

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self._held.set_camera(camera._words())

    @property
    def lights(self) -> Tuple[Light, ...]:
        """The lights, without the environment and emissive surfaces."""
        return tuple(Light._of(words, at) for at, words in enumerate(self._held.lights()))

    @lights.setter
    def lights(self, lights: Iterable[Light]) -> None:
        self._held.set_lights([(light._index, light._words()) for light in lights])

    @property
    def materials(self) -> Tuple[Material, ...]:
        """The materials; to set a value of one changes the scene."""
        texts = self._held.materials()
        return tuple(Material._of(text, self, at) for at, text in enumerate(texts))

    @materials.setter
    def materials(self, materials: Sequence[Material]) -> None:
        count = len(self._held.materials())
        if len(materials) != count:
            raise ValueError(f"the scene has {count} materials, not {len(materials)}")
        edited = self._held.copy()
        for at, material in enumerate(materials):
            edited.set_material(at, material._text())
        self._held = edited

    @property
    def objects(self) -> Tuple[Object, ...]:
        """The objects."""
        rows = self._held.objects()
        return tuple(
            Object(name, kind, material, None if bounds is None else np.array(bounds))
            for name, kind, material, bounds in rows
        )

    def check(self) -> List[Finding]:
        """All that is to be said of it; a scene with errors has no picture."""
        return [Finding(**found) for found in self._held.check()]

    def render(
        self,
        size: Optional[Union[Tuple[int, int], SupportsIndex]] = None,
        spp: Optional[SupportsIndex] = None,
        *,
        supersampling: int | None = None,
        depth: int | None = None,
        settings: Mapping[str, object] | None = None,
        target_error: float | None = None,
        aovs: Sequence[str] = (),
        format: str = "png",
        threads: int = 0,
        max_rays: int | None = None,
        exposure: float | None = None,
        tonemap: str | None = None,
        transparent: bool = False,
        orbit: tuple[float, float] | None = None,
        progress: Progress = False,
        on_picture: Callable[[Image], object] | None = None,
    ) -> Image:
        """Renders its picture; what is not said is as the scene says, or as `rtc render` does.

        `size` is width and height, one number being both; `spp` are paths a pixel of scenes whose paths are
        traced, `supersampling` sub-samples along each side of a pixel of others; `settings` sets any setting of
        the IR by its name, as `{"lightSamples": 4}`. With `target_error`, in grey
        levels of 8 bits, samples are taken until the picture is that good. `aovs` are layers: albedo, normal,
        depth, uv, instance, position. `format` is png or png16 (values as displayed), exr or exr16 (linear).
        `progress` is a function of the share that is done, or True for a bar (by tqdm, if it is there).
        `on_picture` is a function of the picture so far, called up to twenty times a second: finished tiles of
        16 × 16 pixels are as they will be, all others transparent. With `target_error` it is not called.
        Ctrl-C ends it with KeyboardInterrupt; other threads of Python run meanwhile.
        Raises SceneError if the scene has errors, or can't be rendered so.
        """
        words = {
            "format": format,
            "size": _size(size),
            "spp": spp,
            "supersampling": supersampling,
            "depth": depth,
            "settings": {name: json.dumps(plain(value)) for name, value in (settings or {}).items()},
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

        def image(made: _rtc.Picture, layers: List[str]) -> Image:
            return Image(made, clock.perf_counter() - begun, layers, format)

        def show(made: _rtc.Picture) -> None:
            if on_picture is not None:
                on_picture(image(made, []))

        with _Bar(progress) as report:
            made = self._held.render(words, report, None if on_picture is None else show)
        return image(made, list(aovs))

    def cost(self, effort: str = "quick") -> Rows:
        """What accuracy costs in time, as `rtc cost` measures it. Ctrl-C ends it with KeyboardInterrupt.

        Raises SceneError if the scene has errors.
        """
        study = json.loads(self._held.cost(effort))
        return Rows(study, study["rows"])


def _size(size: Optional[Union[Tuple[int, int], SupportsIndex]]) -> Optional[Tuple[int, int]]:
    if size is None:
        return None
    width, height = size if isinstance(size, (tuple, list, np.ndarray)) else (size, size)
    return index(width), index(height)


class _Bar:
    """What shows the progress of a render: a function, a bar of tqdm, or a line."""

    def __init__(self, progress: Progress):
        self._progress = progress
        self._bar: Optional[tqdm[NoReturn]] = None

    def __enter__(self) -> Optional[Callable[[float], object]]:
        if not isinstance(self._progress, bool):
            return self._progress
        if not self._progress:
            return None
        try:
            from tqdm.auto import tqdm

            self._bar = tqdm(total=100, unit="%")
        except ImportError:
            pass
        return self._show

    def _show(self, share: float) -> None:
        if self._bar is None:
            print(f"\r{share:4.0%}", end="", file=sys.stderr, flush=True)
        else:
            self._bar.update(100 * share - self._bar.n)

    def __exit__(self, *failure: object) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._progress is True:
            print(file=sys.stderr)
