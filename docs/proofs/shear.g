# The corner of a triangle, seen from a conservative ray and sheared along it, in single precision
# (TriangleLanes::sheared): within the conservative ray's error of what exact arithmetic gives.
#
# from src/render/accel/conservative_ray.rs: error: ({CORNER} * ROUND * (1.0 + largest) + 2.0 * base + 2.0 * frame.error_bound) as f32,
#
# All is divided by 1 + largest. o and w are coordinates of the origin, across and along the conservative ray; a
# and b those of the corner as seen from it, s the slope. The origin and the slope are rounded when the
# conservative ray is made. A rounding is a factor 1 + e. The main direction is 1; for -1 all signs along it change.
# What underflows is off by 2^-150, and base is at least 2^-36.
CORNER = 10;
u = 1b-24;

exact = a - b * s;
seen = (a - o * e1) * (1 + e2);
along = (b - w * e3) * (1 + e4);
computed = (seen - along * (s * (1 + e5)) * (1 + e6)) * (1 + e7);

grown = (1 + e4) * (1 + e5) * (1 + e6) * (1 + e7);
error = a * (e2 + e7 + e2 * e7) - o * e1 * (1 + e2) * (1 + e7) - s * (b * (grown - 1) - w * e3 * grown);

{ |a| <= 1 /\ |b| <= 1 /\ |o| <= 1 /\ |w| <= 1 /\ |s| <= 1
  /\ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24
  /\ |e5| <= 1b-24 /\ |e6| <= 1b-24 /\ |e7| <= 1b-24
  ->
  computed - exact - error in [0, 0] /\ |error| - (CORNER - 1) * u <= 0 }

computed - exact - error -> 0;
grown - 1 -> e4 + (1 + e4) * (e5 + (1 + e5) * (e6 + e7 + e6 * e7));
