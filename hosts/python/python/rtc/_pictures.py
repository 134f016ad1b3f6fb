"""Pictures as arrays, and how far two of them are apart."""

from __future__ import annotations

import json
import os
import struct
import tempfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Dict, List, Optional

import numpy as np
from numpy.typing import DTypeLike, NDArray

from . import _rtc
from ._program import ask

if TYPE_CHECKING:
    from ._scenes import Finding


class Image:
    """A picture that was rendered. A notebook shows it."""

    def __init__(self, made: _rtc.Picture, seconds: float, aovs: List[str], format: str):
        self._made, self._aovs, self.format = made, aovs, format
        rays, camera, hits, shadow = made.rays
        self.stats = {
            "rays": rays,
            "camera_rays": camera,
            "hits": hits,
            "shadow_rays": shadow,
            "seconds": seconds,
        }

    def __repr__(self) -> str:
        height, width, _ = self._made.shape
        return f"<rtc.Image {width}×{height} {self.format}>"

    @property
    def array(self) -> NDArray[np.float32]:
        """Height × width × 3 (4 with opacity), float32: of png what a display shows, in [0, 1] where it is
        shown; of exr linear values (Rec. 709), times the opacity where there is one."""
        return np.frombuffer(self._made.values(), np.float32).reshape(self._made.shape)

    def __array__(self, dtype: Optional[DTypeLike] = None, copy: Optional[bool] = None) -> np.ndarray:
        return self.array if dtype is None else self.array.astype(dtype)

    @property
    def rgba8(self) -> NDArray[np.uint8]:
        """Height × width × 4, uint8, as a display shows it."""
        height, width, _ = self._made.shape
        return np.frombuffer(self._made.rgba8(), np.uint8).reshape(height, width, 4)

    @property
    def aovs(self) -> Dict[str, NDArray[np.float32]]:
        """The layers that were asked for, each height × width × channels, float32."""
        height, width, _ = self._made.shape

        def layer(name: str) -> NDArray[np.float32]:
            values, channels = self._made.layer(name)
            return np.frombuffer(values, np.float32).reshape(height, width, channels)

        return {name: layer(name) for name in self._aovs}

    @property
    def error(self) -> float | None:
        """The error in grey levels that it has at most, in 90 % of all pictures, if a target error was asked
        for; None where light that no sample met may be far brighter than white."""
        return self._made.error

    @property
    def findings(self) -> List[Finding]:
        """What was found about the scene and in the picture; no errors."""
        from ._scenes import Finding

        return [Finding(**found) for found in self._made.findings()]

    def encode(self) -> bytes:
        """The bytes of its file, those of `rtc render`."""
        return self._made.encode()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes its file, whole or not at all; the name ends in .png or .exr, as its format does."""
        self._made.save(Path(path))

    def _repr_png_(self) -> bytes:
        """The picture in a notebook: its file if that is a PNG, else the colours that a display shows."""
        return self.encode() if self._made.extension == "png" else _png(self.rgba8)


def _png(rgba: NDArray[np.uint8]) -> bytes:
    """A PNG of 8-bit colours with opacity (ISO/IEC 15948)."""
    height, width, _ = rgba.shape
    rows = np.zeros((height, 1 + 4 * width), np.uint8)
    rows[:, 1:] = rgba.reshape(height, 4 * width)

    def chunk(kind: bytes, content: bytes) -> bytes:
        body = kind + content
        return len(content).to_bytes(4, "big") + body + zlib.crc32(body).to_bytes(4, "big")

    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b"")


@dataclass(frozen=True)
class Difference:
    """How far two pictures are apart, in grey levels of 8 bits but for relmse, flip and share."""

    rmse: float
    max: float
    relmse: float
    flip: float
    share: float


def diff(new: Image | str | os.PathLike[str], old: Image | str | os.PathLike[str]) -> Difference:
    """How far a picture, or its file, is from another, as `rtc diff` says. A ValueError tells why they can't
    be compared."""
    with tempfile.TemporaryDirectory() as folder:

        def path(picture: Image | str | os.PathLike[str], name: str) -> str:
            if not isinstance(picture, Image):
                return os.fspath(picture)
            file = Path(folder, f"{name}.{picture._made.extension}")
            picture.save(file)
            return str(file)

        words = ["diff", "--format", "json", "--allow-huge", "--", path(new, "new"), path(old, "old")]
        found = json.loads(ask(words))["difference"]
    return Difference(found["rmse"], found["max"], found["relMse"], found["flip"], found["share"])
