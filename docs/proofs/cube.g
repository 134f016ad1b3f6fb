# The way of a ray into the cube, in double precision (ConservativeRay::new): for the length that may matter a conservative ray
# is within `base` of the ray, and a ray that meets the cube is not reported as a miss.
#
# from src/render/accel/conservative_ray.rs: const MIN_SLOPE: f64 = 1.0 / {STEEP};
# from src/render/accel/conservative_ray.rs: const MIN_DISTANCE: f64 = 1.0 / {FLOOR};
# from src/render/accel/conservative_ray.rs: let base = MIN_DISTANCE + {BASE} * U * (1.0 + distance);
# from src/render/accel/conservative_ray.rs: let start = (distance - {BEFORE}).max(0.0);
# from src/render/accel/conservative_ray.rs: if largest > {REACH} + base
#
# All is divided by 1 + distance, and q is 1 of the cube so divided. x and d are a coordinate of the
# exact origin in the cube and of the exact direction, whose largest is 1; s is the start. The
# scale is a power of two and the main direction is exact. A conservative ray begins within REACH + base of the
# centre and moves by 1 along its main axis, so it is through the cube after REACH + 1 + base. In that
# length the direction adds its error: two roundings, and STEEP where it was made that steep.
STEEP = 1099511627776;
FLOOR = 68719476736;
BASE = 64;
BEFORE = 2;
REACH = 5;
u = 1b-53;

exact = x + d * s;
computed = (x * (1 + e3) + d * ((1 + e1) * (1 + e2)) * s * (1 + e5)) * (1 + e6);
origin = x * ((1 + e3) * (1 + e6) - 1) + d * s * ((1 + e1) * (1 + e2) * (1 + e5) * (1 + e6) - 1);
slope = (1 + e1) * (1 + e2) - 1;

of_cube = 1 / FLOOR * (1 + e8);
of_distance = BASE * u * (1 + e7) * (1 + e9) * (1 + e8);
base = q * of_cube + of_distance;
rest = |origin| + |slope| * ((REACH + 1) * q + base) + base / STEEP;

# A point of the cube is within 1 of the centre. The ray is there at most 1 + distance after its origin,
# so from the start at most 1 + BEFORE, and what rounds in the start.
first = 1 + (1 + BEFORE) + BEFORE * 2 * u;

{ |x| <= 1.0001 /\ |d| <= 1 /\ s in [0, 1] /\ q in [0, 1]
  /\ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53
  /\ |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53
  ->
  computed - exact - origin in [0, 0]
  /\ of_cube - (REACH + 1) / STEEP >= 0
  /\ of_distance - rest >= 0
  /\ REACH - first >= 0 }

computed - exact - origin -> 0;
