"""`denoise_oidn.py WIDTH HEIGHT`: filters a picture by Open Image Denoise (pyoidn, of PyPI), for
benches/denoise.rs. Standard input has f32 numbers: the colours of all pixels, linear, then the
albedo and the normal of each; the colours come out."""

import sys

import numpy
import pyoidn

width, height = map(int, sys.argv[1:])
numbers = numpy.frombuffer(sys.stdin.buffer.read(), "<f4").reshape(-1, height, width, 3)
guides = numpy.ascontiguousarray(numbers.reshape(3, -1)[1:].reshape(height, width, 6))
color, albedo, normal = map(numpy.ascontiguousarray, (numbers[0], guides[..., :3], guides[..., 3:]))
sys.stdout.buffer.write(pyoidn.denoise(color, albedo=albedo, normal=normal, hdr=True).tobytes())
