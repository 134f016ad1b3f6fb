# The plane in double precision (Normal::parameter, Normal::is_beyond): the root, and what plain
# arithmetic may tell of it.
#
# from src/render/shape/plane.rs: let distance_error = {DISTANCE} * U * sizes.dot(to_anchor.abs()) + f64::MIN_POSITIVE;
# from src/render/shape/plane.rs: let slope_error = {SLOPE} * U * sizes.dot(ray.direction.abs()) + f64::MIN_POSITIVE;
# from src/render/shape/plane.rs: let limit = (slope.abs() + slope_error) * (t_max * (1.0 + {BEYOND} * U));
# from src/render/shape/plane.rs: with an error of at most {ROOT} u; `None` for a
#
# 1. The compensated dot product (math::dot). Its terms z1, z2, z3 are at most 1 in sum of absolute
#    values; all is divided by that sum. two_product and two_sum are exact (Dekker, Knuth), so their errors
#    stand here as what they are. The result is the exact sum with one rounding, and `second` besides.
# 2. N.(anchor - p): the differences are exact as pairs; the dot product of their second parts, at most
#    u of the sum, has four roundings, and the last sum one.
# 3. The root: one rounding from each of slope and of both sums of the distance, one of the quotient, and the
#    second-order parts times the condition numbers of distance and slope, sum |N||v| / |N.v|. These are taken to be
#    at most 2^48: beyond it the plane is a point of rounding noise.
# 4. What is_beyond tells: its bounds hold, and with them a root is computed to be at least t_max.
DISTANCE = 5;
SLOPE = 4;
BEYOND = 16;
ROOT = 10;
SECOND = 32;
u = 1b-53;

x = z1 * (1 + e1); xe = - z1 * e1;
y = z2 * (1 + e2); ye = - z2 * e2;
z = z3 * (1 + e3); ze = - z3 * e3;
xy = (x + y) * (1 + e4); xye = - (x + y) * e4;
xyz = (xy + z) * (1 + e5); xyze = - (xy + z) * e5;
low = ((xe + ye) * (1 + f1) + xye) * (1 + f2);
high = (ze + xyze) * (1 + f3);
dot = (xyz + (low + high) * (1 + f4)) * (1 + f5);
lost = (xe + ye) * ((1 + f1) * (1 + f2) * (1 + f4) - 1) + xye * ((1 + f2) * (1 + f4) - 1)
     + (ze + xyze) * ((1 + f3) * (1 + f4) - 1);

tails = a * ((1 + h1) * (1 + h2) * (1 + h3) - 1);

distance = (1 + r1) * (1 + r2) + c1 * (SECOND * u * u);
slope = (1 + r3) + c2 * (SECOND * u * u);
root = distance / slope * (1 + r4);

v1 = (1 + b1) * (1 + b2) * (1 + b3) - 1 / (1 + b0);
v2 = (1 + b1) * (1 + b2) * (1 + b3) - 1;
grown = (1 + b4) * (1 + b5) * (1 + b6) * (1 + b7) * (1 + b8);
told = (1 + k1) * (1 + BEYOND * u) * (1 + k2) * (1 + k3) * (1 + k4) * (1 - ROOT * u);

{ |z1| <= 1 /\ |z2| <= 1 /\ |z3| <= 1 /\ |x + y| <= 1.01 /\ |xy + z| <= 1.01 /\ |xe + ye| <= 1b-53
  /\ |a| <= 1b-53 /\ |c1| <= 1b48 /\ |c2| <= 1b48
  /\ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53
  /\ |f1| <= 1b-53 /\ |f2| <= 1b-53 /\ |f3| <= 1b-53 /\ |f4| <= 1b-53 /\ |f5| <= 1b-53
  /\ |h1| <= 1b-53 /\ |h2| <= 1b-53 /\ |h3| <= 1b-53
  /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53
  /\ |b0| <= 1b-53 /\ |b1| <= 1b-53 /\ |b2| <= 1b-53 /\ |b3| <= 1b-53 /\ |b4| <= 1b-53
  /\ |b5| <= 1b-53 /\ |b6| <= 1b-53 /\ |b7| <= 1b-53 /\ |b8| <= 1b-53
  /\ |k1| <= 1b-53 /\ |k2| <= 1b-53 /\ |k3| <= 1b-53 /\ |k4| <= 1b-53
  ->
  dot - ((z1 + z2 + z3) + lost) * (1 + f5) in [0, 0]
  /\ |lost| + |tails| <= 31b-106
  /\ |root - 1| <= 10b-53
  /\ DISTANCE * u * grown - |v1| >= 0
  /\ SLOPE * u * grown - |v2| >= 0
  /\ told >= 1 }

dot - ((z1 + z2 + z3) + lost) * (1 + f5) -> 0;
