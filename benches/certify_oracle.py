"""The values of pixels by MPFR with 200 bits, from the IR of a scene as JSON: the formulas of the
book, written apart from `rtc` in another language. Only decisions closer than 2⁻¹⁶⁰ could go wrong.
"""

import base64
import struct

import gmpy2
from gmpy2 import mpfr, sqrt

gmpy2.get_context().precision = 200

# A ray does not meet its own start again: roots below this are that start.
START = mpfr(2) ** -100
MASK = (1 << 64) - 1


class Unsupported(Exception):
    """A feature that is not evaluated here."""


# Vectors are triples.
def exact(v):
    return tuple(mpfr(x) for x in v)


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def neg(a):
    return (-a[0], -a[1], -a[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - b[1] * a[2], a[2] * b[0] - b[2] * a[0], a[0] * b[1] - b[0] * a[1])


def unit(a):
    return mul(a, 1 / sqrt(dot(a, a)))


def mean(values, weights):
    return sum(v * w for v, w in zip(values, weights))


# Random numbers: SplitMix64 and the keys of paths.
def mix(x):
    x = (x + 0x9E3779B97F4A7C15) & MASK
    x = ((x ^ (x >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    x = ((x ^ (x >> 27)) * 0x94D049BB133111EB) & MASK
    return x ^ (x >> 31)


def child(key, branch):
    return mix((((key << 32) | (key >> 32)) & MASK) ^ mix(branch))


def fraction(bits):
    return mpfr(bits >> 11) / 2**53


def spiral(k, rotation):
    """The cosine and the sine of k golden angles and a rotation."""
    turns = (k * 0x61C8864680B583EB + rotation) & MASK
    angle = 2 * gmpy2.const_pi() * turns / 2**64
    return gmpy2.cos(angle), gmpy2.sin(angle)


def basis(n):
    """Two vectors at right angles to a unit vector (Duff et al., 2017)."""
    sign = -1 if n[2] < 0 else 1
    a = -1 / (sign + n[2])
    b = n[0] * n[1] * a
    return (1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]), (b, sign + n[1] * n[1] * a, -n[1])


def real_roots(coefficients, low, high):
    """The roots of a polynomial, highest power first, between two numbers: between those of its
    derivative it is monotone."""
    degree = len(coefficients) - 1

    def value(x):
        result = coefficients[0]
        for c in coefficients[1:]:
            result = result * x + c
        return result

    if degree == 1:
        a, b = coefficients
        return [-b / a] if a != 0 and low <= -b / a <= high else []
    slope = [c * (degree - k) for k, c in enumerate(coefficients[:-1])]
    borders = [low] + real_roots(slope, low, high) + [high]
    roots = []
    for a, b in zip(borders, borders[1:]):
        first, last = value(a), value(b)
        if (first < 0) == (last < 0):
            continue
        # Newton's method, or bisection where it leaves the bracket.
        x = (a + b) / 2
        for _ in range(400):
            here = value(x)
            if (here < 0) == (first < 0):
                a = x
            else:
                b = x
            steep = slope[0]
            for c in slope[1:]:
                steep = steep * x + c
            step = x - here / steep if steep != 0 else a
            after = step if a < step < b else (a + b) / 2
            if abs(after - x) <= abs(x) * mpfr(2) ** -190:
                break
            x = after
        roots.append(x)
    return roots


# Shapes: each has `hits(o, d)`, all (t, normal, uv or None, other) in front of the start, in no
# order.
class Shape:
    ball = None

    def uv(self, hit, point):
        return None

    def shading_normal(self, hit, point):
        return None


class Sphere(Shape):
    def __init__(self, s):
        self.center, self.radius = exact(s["center"]), mpfr(s["radius"])
        self.ball = (self.center, self.radius)
        self.rows = [
            exact(r) for r in s.get("textureFromWorld") or [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        ]

    def hits(self, o, d):
        f = sub(o, self.center)
        b = -dot(f, d)
        foot = add(f, mul(d, b))
        inside = self.radius**2 - dot(foot, foot)
        if inside < 0:
            return
        root = sqrt(inside)
        for t in (b - root, b + root):
            yield t, mul(add(f, mul(d, t)), 1 / self.radius), None

    def uv(self, hit, point):
        n = hit[1]
        x, y, z = (dot(row, n) for row in self.rows)
        pi = gmpy2.const_pi()
        turns = gmpy2.atan2(y, x) / (2 * pi)
        return turns + 1 if turns < 0 else turns, 1 - gmpy2.acos(max(-1, min(1, z))) / pi


def plane_hit(o, d, center, normal):
    slope = dot(normal, d)
    return None if slope == 0 else dot(normal, sub(center, o)) / slope


class Plane(Shape):
    def __init__(self, s):
        self.center, self.normal = exact(s["center"]), unit(exact(s["normal"]))

    def hits(self, o, d):
        t = plane_hit(o, d, self.center, self.normal)
        if t is not None:
            yield t, self.normal, None


class Disc(Plane):
    def __init__(self, s):
        super().__init__(s)
        self.radius = mpfr(s["radius"])
        self.ball = (self.center, self.radius)

    def hits(self, o, d):
        for t, n, _ in super().hits(o, d):
            local = sub(add(o, mul(d, t)), self.center)
            if dot(local, local) < self.radius**2:
                yield t, n, None


def ball_around(points):
    center = mul(points[0], mpfr(0))
    for p in points:
        center = add(center, mul(p, mpfr(1) / len(points)))
    return center, max(sqrt(dot(sub(p, center), sub(p, center))) for p in points)


class Triangle(Shape):
    def __init__(self, vertices, uvs=None, normals=None, side=1):
        self.v = vertices
        self.side = side
        self.uvs, self.normals = uvs, normals
        self.raw = cross(sub(vertices[1], vertices[0]), sub(vertices[2], vertices[0]))
        self.empty = dot(self.raw, self.raw) == 0
        self.ball = ball_around(vertices)

    def hits(self, o, d):
        if self.empty:
            return
        a, b, c = (sub(v, o) for v in self.v)
        volumes = [dot(d, cross(a, b)), dot(d, cross(b, c)), dot(d, cross(c, a))]
        # A start in the plane has volumes of 0 with the rounding of 200 bits: it is no hit anyway.
        if min(volumes) < 0 < max(volumes):
            return
        t = plane_hit(o, d, self.v[0], self.raw)
        if t is not None:
            yield t, mul(unit(self.raw), self.side), None

    def weights(self, p):
        a, b, c = self.v
        area = dot(self.raw, self.raw)
        w1 = dot(cross(sub(p, a), sub(c, a)), self.raw) / area
        w2 = dot(cross(sub(b, a), sub(p, a)), self.raw) / area
        return 1 - w1 - w2, w1, w2

    def uv(self, hit, point):
        if self.uvs is None:
            return None
        w = self.weights(point)
        return tuple(mean((uv[k] for uv in self.uvs), w) for k in (0, 1))

    def shading_normal(self, hit, point):
        if self.normals is None:
            return None
        w = self.weights(point)
        return unit(tuple(mean((n[k] for n in self.normals), w) for k in (0, 1, 2)))


class Patch(Shape):
    """A bilinear patch: roots of a quadratic in u (Reshetov, Ray Tracing Gems, ch. 8)."""

    def __init__(self, v):
        self.v = v
        self.ball = ball_around(v)

    def hits(self, o, d):
        q00, q10, q11, q01 = (sub(v, o) for v in self.v)
        left, right = sub(q01, q00), sub(q11, q10)
        a = dot(cross(q00, d), left)
        c = dot(cross(sub(q10, q00), sub(q01, q11)), d)
        b = dot(cross(q10, d), right) - a - c
        for u in real_roots([c, b, a] if c != 0 else [b, a], mpfr(0), mpfr(1)):
            start = add(q00, mul(sub(q10, q00), u))
            line = add(left, mul(sub(right, left), u))
            n = cross(d, line)
            v = dot(cross(n, start), d) / dot(n, n)
            if 0 <= v <= 1:
                across = add(mul(sub(q10, q00), 1 - v), mul(sub(q11, q01), v))
                normal = cross(across, line)
                t = dot(normal, add(start, mul(line, v))) / dot(normal, d)
                yield t, unit(normal), (u, v)

    def uv(self, hit, point):
        return hit[2]


def is_flat(v):
    """Whether corners lie in one plane to 64 units of rounding; unsupported near that border."""
    a, b, c, d = v
    n = add(cross(sub(b, a), sub(c, a)), cross(sub(c, a), sub(d, a)))
    size = max(sum(abs(x) for x in p) for p in v)
    limit = 64 * mpfr(2) ** -53 * size * sqrt(dot(n, n))
    off = max(abs(dot(sub(p, a), n)) for p in (b, c, d))
    if limit / 4 < off < 4 * limit:
        raise Unsupported("a nearly flat quad")
    return off <= limit


def quad(s):
    v = [exact(p) for p in s["vertices"]]
    if not is_flat(v):
        return [Patch(v)]
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    for split in (((0, 1, 2), (0, 2, 3)), ((0, 1, 3), (1, 2, 3))):
        halves = [Triangle([v[k] for k in h], [exact(corners[k]) for k in h]) for h in split]
        if dot(halves[0].raw, halves[1].raw) >= 0:
            return halves
    raise Unsupported("a quad without an inner diagonal")


class Solid(Shape):
    """Around an axis: a point at height h and radius ρ."""

    def frame(self, base, axis):
        self.base, self.axis = base, unit(axis)

    def parts(self, o, d):
        f = sub(o, self.base)
        h, rise = dot(f, self.axis), dot(d, self.axis)
        return sub(f, mul(self.axis, h)), sub(d, mul(self.axis, rise)), h, rise

    def cap(self, o, d, height, radius, sign):
        w, x, h, rise = self.parts(o, d)
        if rise != 0:
            t = (height - h) / rise
            at = add(w, mul(x, t))
            if dot(at, at) < radius**2:
                yield t, mul(self.axis, mpfr(sign)), None


class Cylinder(Solid):
    def __init__(self, s):
        self.frame(exact(s["base"]), exact(s["axis"]))
        self.height, self.radius = mpfr(s["height"]), mpfr(s["radius"])
        middle = add(self.base, mul(self.axis, self.height / 2))
        self.ball = (middle, self.height / 2 + self.radius)

    def hits(self, o, d):
        w, x, h, rise = self.parts(o, d)
        a = dot(x, x)
        if a != 0:
            b = -dot(w, x) / a
            foot = add(w, mul(x, b))
            inside = (self.radius**2 - dot(foot, foot)) / a
            if inside >= 0:
                for t in (b - sqrt(inside), b + sqrt(inside)):
                    if 0 < h + rise * t < self.height:
                        yield t, mul(add(w, mul(x, t)), 1 / self.radius), None
        yield from self.cap(o, d, mpfr(0), self.radius, -1)
        yield from self.cap(o, d, self.height, self.radius, 1)


class Cone(Solid):
    def __init__(self, s):
        up = exact(s["up"])
        self.frame(exact(s["base"]), up)
        self.height, self.radius = sqrt(dot(up, up)), mpfr(s["radius"])
        self.ball = (self.base, max(self.height, self.radius))

    def hits(self, o, d):
        w, x, h, rise = self.parts(o, d)
        k = self.radius / self.height
        sigma, tau = k * (self.height - h), k * rise
        # |w + x·t|² = (σ − τ·t)².
        a = dot(x, x) - tau**2
        b = dot(w, x) + sigma * tau
        c = dot(w, w) - sigma**2
        if a == 0:
            roots = [-c / (2 * b)] if b != 0 else []
        else:
            q = b**2 - a * c
            roots = [] if q < 0 else [(-b - sqrt(q)) / a, (-b + sqrt(q)) / a]
        for t in roots:
            if 0 < h + rise * t < self.height:
                radial = unit(add(w, mul(x, t)))
                yield t, unit(add(mul(radial, self.height), mul(self.axis, self.radius))), None
        yield from self.cap(o, d, mpfr(0), self.radius, -1)


class Torus(Solid):
    def __init__(self, s):
        self.frame(exact(s["center"]), exact(s["axis"]))
        self.major, self.minor = mpfr(s["major"]), mpfr(s["minor"])
        self.ball = (self.base, self.major + self.minor)

    def hits(self, o, d):
        # From the point nearest to the centre: (|p|² + R² − r²)² = 4·R²·ρ².
        f = sub(o, self.base)
        nearest = -dot(f, d)
        w, x, h, rise = self.parts(add(o, mul(d, nearest)), d)
        square = dot(w, w) + h**2
        k = square + self.major**2 - self.minor**2
        r4 = 4 * self.major**2
        quartic = [
            mpfr(1),
            mpfr(0),
            2 * k - r4 * dot(x, x),
            -2 * r4 * dot(w, x),
            k**2 - r4 * dot(w, w),
        ]
        reach = self.major + self.minor + 1
        for s in real_roots(quartic, -reach, reach):
            at = add(w, mul(x, s))
            ring = mul(unit(at), self.major)
            local = sub(add(at, mul(self.axis, h + rise * s)), ring)
            yield nearest + s, mul(local, 1 / self.minor), None


def instance(s, meshes):
    mesh = meshes[s["mesh"]]
    x, y, z, origin = (exact(c) for c in s["worldFromObject"])
    place = lambda p: add(add(mul(x, p[0]), mul(y, p[1])), add(mul(z, p[2]), origin))
    volume = dot(cross(x, y), z)
    rows = [
        mul(cross(y, z), 1 / volume),
        mul(cross(z, x), 1 / volume),
        mul(cross(x, y), 1 / volume),
    ]
    turned = lambda n: add(add(mul(rows[0], n[0]), mul(rows[1], n[1])), mul(rows[2], n[2]))
    positions, normals, uvs = (column(mesh.get(key)) for key in ("positions", "normals", "uvs"))
    positions = [place(p) for p in positions]
    normals = [turned(unit(n)) for n in normals]
    for corners in mesh["triangles"]:
        of = lambda values: [values[k] for k in corners] if values else None
        yield Triangle(of(positions), of(uvs), of(normals), -1 if volume < 0 else 1)


def column(values):
    """A column of vertices, of 64 or 32 bits, whose decimals are the shortest of their kind."""
    if isinstance(values, dict):
        values = [struct.unpack(f"{len(v)}f", struct.pack(f"{len(v)}f", *v)) for v in values["f32"]]
    return [exact(v) for v in values or []]


def shapes(shape, meshes):
    [(kind, s)] = shape.items()
    one = {
        "sphere": Sphere,
        "plane": Plane,
        "disc": Disc,
        "cylinder": Cylinder,
        "cone": Cone,
        "torus": Torus,
    }
    if kind in one:
        return [one[kind](s)]
    if kind == "triangle":
        uvs = s.get("uvs")
        return [Triangle([exact(v) for v in s["vertices"]], uvs and [exact(uv) for uv in uvs])]
    if kind == "quad":
        return quad(s)
    if kind == "instance":
        return list(instance(s, meshes))
    raise Unsupported(kind)


class Image:
    def __init__(self, image):
        self.width, self.height = image["width"], image["height"]
        kind = image.get("kind", "rgb8")
        if kind == "rgb32f":
            raise Unsupported("float images")
        self.bytes, self.step = base64.b64decode(image["pixels"]), 4 if kind == "rgba8" else 3

    def texel(self, column, row):
        start = (row * self.width + column) * self.step
        return exact(self.bytes[start : start + 3])

    def bilinear(self, u, v):
        def repeated(x):
            return x if 0 <= x <= 1 else x - gmpy2.floor(x)

        def split(place, count):
            texel = max(0, min(count - 1, int(gmpy2.floor(place))))
            return texel, place - texel

        column, x = split(repeated(u) * (self.width - 1), self.width)
        row, y = split((1 - repeated(v)) * (self.height - 1), self.height)
        right, below = min(column + 1, self.width - 1), min(row + 1, self.height - 1)
        mixed = lambda a, b, s: add(a, mul(sub(b, a), s))
        top = mixed(self.texel(column, row), self.texel(right, row), x)
        bottom = mixed(self.texel(column, below), self.texel(right, below), x)
        return mul(mixed(top, bottom, y), mpfr(1) / 255)


class Scene:
    def __init__(self, ir):
        if ir.get("environment"):
            raise Unsupported("an environment")
        self.settings = settings = ir["settings"]
        self.mode = settings.get("mode", "phong")
        if isinstance(self.mode, dict) and "path" in self.mode:
            raise Unsupported("path tracing")
        for key in ("toon", "stereo", "background"):
            if settings.get(key):
                raise Unsupported(key)
        if any("point" not in light for light in ir.get("lights", [])):
            raise Unsupported("lights with falloff")
        self.lights = [light["point"] for light in ir.get("lights", [])]
        self.images = [Image(image) for image in ir.get("images", [])]
        self.textures = ir.get("textures", [])
        self.materials = ir["materials"]
        self.shapes = []
        for index, surface in enumerate(ir["surfaces"]):
            for shape in shapes(surface["shape"], ir.get("meshes", [])):
                shape.material = self.materials[surface["material"]].get("phong")
                if shape.material is None:
                    raise Unsupported("a standard material")
                shape.casts = not surface.get("castsNoShadow", False)
                shape.float_ball = shape.ball and (
                    [float(x) for x in shape.ball[0]],
                    float(shape.ball[1]),
                )
                self.shapes.append(shape)
        camera = ir["camera"]
        self.eye, self.center = exact(camera["eye"]), exact(camera["center"])
        self.right, self.up = exact(camera["right"]), exact(camera["up"])
        self.size = camera["size"]
        self.parallel = camera.get("projection", "perspective") == "orthographic"
        lens = camera.get("lens", {"radius": 0, "samples": 1})
        self.lens_radius = mpfr(lens["radius"])
        self.lens_samples = 1 if lens["radius"] == 0 else lens["samples"]
        self.shadows = settings.get("shadows", False)
        self.light_samples = settings.get("lightSamples", 1)

    # Rays.
    def candidates(self, o, d):
        """The shapes whose balls the ray may meet, with a wide margin for the rounding of this
        test."""
        of, df = [float(x) for x in o], [float(x) for x in d]
        for shape in self.shapes:
            if shape.float_ball:
                c, r = shape.float_ball
                f = (of[0] - c[0], of[1] - c[1], of[2] - c[2])
                b = f[0] * df[0] + f[1] * df[1] + f[2] * df[2]
                square = f[0] * f[0] + f[1] * f[1] + f[2] * f[2]
                reach = r * r * (1 + 1e-6) + 1e-6 * square
                if square - b * b > reach or (b > 0 and square > reach):
                    continue
            yield shape

    def first_hit(self, o, d):
        best = None
        for shape in self.candidates(o, d):
            for hit in shape.hits(o, d):
                if hit[0] > START and (best is None or hit[0] < best[1][0]):
                    best = shape, hit
        return best

    def is_hidden(self, o, d, distance):
        for shape in self.candidates(o, d):
            if shape.casts and any(START < hit[0] < distance for hit in shape.hits(o, d)):
                return True
        return False

    # Pixels.
    def samples(self, pixel):
        """The rays of a pixel, each with its key."""
        factor = self.settings.get("supersampling", 1)
        pattern = self.settings.get("pattern", "grid")
        base = mix(pixel[0] << 32 | pixel[1])
        for cell in range(factor * factor):
            column, row = cell % factor, cell // factor
            offset = (mpfr(1) / 2, mpfr(1) / 2)
            if pattern != "grid":
                key = child(child(base, cell), MASK)
                offset = tuple(fraction(child(key, axis)) for axis in (0, 1))
            if pattern != "random":
                offset = ((column + offset[0]) / factor, (row + offset[1]) / factor)
            target = self.target(pixel, offset)
            for k in range(self.lens_samples):
                yield (*self.ray(target, k), child(base, cell * self.lens_samples + k))

    def target(self, pixel, offset):
        across = pixel[0] + offset[0] - mpfr(self.size[0]) / 2
        upward = mpfr(self.size[1]) / 2 - pixel[1] - offset[1]
        return add(self.center, add(mul(self.right, across), mul(self.up, upward)))

    def ray(self, target, k):
        origin = self.eye
        if self.lens_samples > 1 or self.lens_radius != 0:
            r = self.lens_radius * sqrt(mpfr(k) / self.lens_samples) / sqrt(dot(self.up, self.up))
            x, y = spiral(k, 0)
            origin = add(origin, add(mul(self.right, r * x), mul(self.up, r * y)))
        if self.parallel:
            origin = add(origin, sub(target, self.center))
        return origin, unit(sub(target, origin))

    def pixel(self, pixel):
        """The mean of the samples, each clamped to [0, 1]."""
        total, count = (mpfr(0),) * 3, 0
        for o, d, key in self.samples(pixel):
            value = self.radiance(o, d, key, self.settings.get("maxDepth", 0), mpfr(1))
            total = add(total, tuple(max(mpfr(0), min(mpfr(1), x)) for x in value))
            count += 1
        return mul(total, mpfr(1) / count)

    def depths(self, pixels):
        """The greys of pixels in a depth buffer: (t_max − t)/(t_max − t_min)."""
        half = (mpfr(1) / 2,) * 2
        rays = {}
        width, height = self.size
        # The extremes by 53 bits, then exactly among those that come near them.
        rough = []
        gmpy2.get_context().precision = 53
        for y in range(height):
            for x in range(width):
                hit = self.first_hit(*self.ray(self.target((x, y), half), 0))
                if hit:
                    rough.append((float(hit[1][0]), (x, y)))
        gmpy2.get_context().precision = 200
        t_of = lambda p: self.first_hit(*self.ray(self.target(p, half), 0))
        near, far = min(rough)[0], max(rough)[0]
        near = min(t_of(p)[1][0] for t, p in rough if t < near * (1 + 1e-9))
        far = max(t_of(p)[1][0] for t, p in rough if t > far * (1 - 1e-9))
        for p in pixels:
            hit = t_of(p)
            yield p, ((far - hit[1][0]) / (far - near) if hit else mpfr(0),) * 3

    # Shading.
    def radiance(self, o, d, key, bounces, beta):
        hit = self.first_hit(o, d)
        if hit is None:
            return (mpfr(0),) * 3
        at = Point(self, *hit, o, d, key)
        if self.mode == "normal":
            return tuple((x + 1) / 2 for x in at.normal)
        if self.mode != "phong":
            return self.gooch(at, self.mode["gooch"])
        value = mul(self.phong(at), beta)
        if bounces > 0:
            for direction, weight, branch in self.branches(at, d):
                if weight != 0:
                    value = add(
                        value,
                        self.radiance(at.point, direction, branch, bounces - 1, beta * weight),
                    )
        return value

    def phong(self, at):
        m = at.material
        ambient = mul(at.color, mpfr(m["ka"]))
        total = (mpfr(0),) * 3
        if self.settings.get("ambient", "perLight") == "once":
            light = self.settings.get("ambientLight", [1, 1, 1])
            total = tuple(mpfr(a) * b for a, b in zip(light, ambient))
            ambient = (mpfr(0),) * 3
        for index, light in enumerate(self.lights):
            position, radius = exact(light["position"]), mpfr(light.get("radius", 0))
            if radius > 0 and self.light_samples > 1:
                towards = basis(unit(sub(position, at.point)))
                rotation = child(child(at.key, index), 2)
                direct = (mpfr(0),) * 3
                for k in range(self.light_samples):
                    r = radius * sqrt((k + mpfr(1) / 2) / self.light_samples)
                    x, y = spiral(k, rotation)
                    place = add(position, add(mul(towards[0], r * x), mul(towards[1], r * y)))
                    direct = add(direct, self.direct(at, place))
                direct = mul(direct, mpfr(1) / self.light_samples)
            else:
                direct = self.direct(at, position)
            term = add(ambient, direct)
            total = add(total, tuple(mpfr(c) * x for c, x in zip(light["color"], term)))
        return total

    def direct(self, at, light):
        m = at.material
        offset = sub(light, at.point)
        distance = sqrt(dot(offset, offset))
        to_light = mul(offset, 1 / distance)
        n_dot_l = dot(at.normal, to_light)
        if self.shadows:
            if n_dot_l <= 0 or dot(at.geometric, to_light) <= 0:
                return (mpfr(0),) * 3
            if self.is_hidden(at.point, to_light, distance):
                return (mpfr(0),) * 3
        r_dot_v = dot(sub(mul(at.normal, 2 * n_dot_l), to_light), at.to_viewer)
        highlight = at.ks * power(r_dot_v, mpfr(m["n"]))
        return tuple(c * mpfr(m["kd"]) * max(mpfr(0), n_dot_l) + highlight for c in at.color)

    def gooch(self, at, g):
        m, total = at.material, (mpfr(0),) * 3
        for light in self.lights:
            to_light = unit(sub(exact(light["position"]), at.point))
            n_dot_l = dot(at.normal, to_light)
            c = exact(light["color"])
            tone = tuple(a * b * mpfr(m["kd"]) for a, b in zip(c, at.color))
            cool = add((mpfr(0), mpfr(0), mpfr(g["b"])), mul(tone, mpfr(g["alpha"])))
            warm = add((mpfr(g["y"]), mpfr(g["y"]), mpfr(0)), mul(tone, mpfr(g["beta"])))
            total = add(total, add(mul(cool, (1 - n_dot_l) / 2), mul(warm, (1 + n_dot_l) / 2)))
            r_dot_v = dot(sub(mul(at.normal, 2 * n_dot_l), to_light), at.to_viewer)
            total = add(total, mul(c, at.ks * power(r_dot_v, mpfr(m["n"]))))
        return total

    def branches(self, at, d):
        """The reflected and the refracted rays: direction, weight and key."""
        m = at.material
        kt, refracted, reflected = mpfr(m.get("kt", 0)), None, mpfr(1)
        if kt != 0:
            if at.normal != at.geometric:
                raise Unsupported("refraction by a shading normal")
            eta = mpfr(m["eta"])
            source, beyond = (mpfr(1), eta) if dot(d, at.declared) <= 0 else (eta, mpfr(1))
            along = sub(d, mul(at.normal, dot(d, at.normal)))
            square = beyond**2 - source**2 * dot(along, along)
            if square >= 0:
                refracted = mul(sub(mul(along, source), mul(at.normal, sqrt(square))), 1 / beyond)
                reflected = mpfr(0)
                if m.get("fresnel") and eta != 1:
                    r0 = ((eta - 1) / (eta + 1)) ** 2
                    reflected = r0 + (1 - r0) * (1 + dot(d, at.normal)) ** 5
        kr = at.ks if m.get("kr") is None else mpfr(m["kr"])
        weight = kr + kt * reflected
        mirror = sub(d, mul(at.normal, 2 * dot(d, at.normal)))
        if dot(mirror, at.declared) * dot(d, at.declared) > 0:
            mirror = sub(d, mul(at.declared, 2 * dot(d, at.declared)))
        samples = m.get("glossySamples", 1)
        if samples > 1 and weight != 0:
            rays = list(self.lobe(at, mirror, samples))
            for k, direction in rays:
                yield direction, weight / len(rays), child(child(at.key, 0), k)
        else:
            yield mirror, weight, child(at.key, 0)
        if refracted is not None:
            yield refracted, kt * (1 - reflected), child(at.key, 1)

    def lobe(self, at, axis, count):
        shift, rotation = fraction(child(at.key, 0)), child(at.key, 1)
        first, second = basis(axis)
        for k in range(count):
            cosine = ((k + shift) / count) ** (1 / (mpfr(at.material["n"]) + 1))
            sine = sqrt(1 - cosine**2)
            x, y = spiral(k, rotation)
            direction = add(add(mul(first, sine * x), mul(second, sine * y)), mul(axis, cosine))
            geometric = at.geometric if self.shadows else at.normal
            if dot(direction, at.normal) > 0 and dot(direction, geometric) > 0:
                yield k, direction


def power(x, n):
    if x <= 0:
        return mpfr(1) if n == 0 else mpfr(0)
    return min(x, mpfr(1)) ** n


class Point:
    """A point of a surface, seen from one side."""

    def __init__(self, scene, shape, hit, o, d, key):
        self.material, self.key = shape.material, key
        self.point, self.declared = add(o, mul(d, hit[0])), hit[1]
        self.to_viewer = neg(d)
        faces_away = dot(d, self.declared) > 0
        self.geometric = neg(self.declared) if faces_away else self.declared
        normal = shape.shading_normal(hit, self.point) or self.declared
        self.normal = neg(normal) if faces_away else normal
        m = self.material
        self.color, self.ks = exact(m["color"]), mpfr(m["ks"])
        if m.get("normalMap") is not None or m.get("bump") is not None:
            raise Unsupported("normal and bump maps")
        maps = [m.get("colorMap"), m.get("specularMap")]
        if scene.mode != "normal" and any(one is not None for one in maps):
            uv = shape.uv(hit, self.point)
            if uv is not None:
                color, specular = (
                    one if one is None else looked_up(scene, one, uv) for one in maps
                )
                self.color = self.color if color is None else color
                self.ks *= 1 if specular is None else max(mpfr(0), specular[0])


def looked_up(scene, texture, uv):
    texture = scene.textures[texture]
    if texture == "uv":
        return uv[0], mpfr(0), uv[1]
    if "image" in texture:
        return scene.images[texture["image"]].bilinear(*uv)
    raise Unsupported("textures of glTF and patterns")


def level(x):
    return max(0, min(255, int(gmpy2.floor(255 * x))))
