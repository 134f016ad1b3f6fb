# The sphere in double precision (Sphere::intersect): what its early tests leave out has no root above 0, and
# the sign of a discriminant beyond its bound is right.
#
# from src/render/shape/sphere.rs: let outside = f2 * number(1.0 - {OUTSIDE} * U) - r2;
# from src/render/shape/sphere.rs: r2.less(f2 * number(1.0 - {BEHIND} * U))
# from src/render/shape/sphere.rs: number({BOUND} * U) * (sizes + number({SECOND} * U) * extent * extent);
#
# The direction is divided by its length, which all tests scale by. Sums of squares, of |f||d|, and others of one
# sign: roundings of their terms are one rounding of the sum, their weighted mean.
# 1. Beside or beyond (outside): F is 1. If there is a root, F^2 - r^2 <= b^2. f2 has two roundings of f, one of
#    the product, two of sums; a, b and r2 likewise.
#    So left is at most b^2 - 40 u + 7 u, and the square of the computed b at least b^2 - 14 u.
# 2. Behind (behind): the squares as computed, so far apart, have exact ones of that order.
# 3. The discriminant: the computed foot is the exact one, plus d * E * g, plus h. E is the sum of |F|. Along the
#    ray (g) lies the error of b / a; beside it (h) the roundings of f, of the product d * t and of the last sum.
#    The exact foot is at a right angle to d, so g counts only squared and with h. If the sign is wrong, one of the
#    two feet is within the radius, which is 1, or a rounding more; of that one is taken the
#    product with h. off_1, off_E, off_EE are the coefficients of 1, E and E^2 in the error; the roundings of foot2,
#    ROUNDED, are of the computed foot2 itself.
OUTSIDE = 64;
BEHIND = 8;
BOUND = 16;
SECOND = 16 * 1;
u = 1b-53;

f2 = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5);
a = (1 + e6) * (1 + e7) * (1 + e8);
left = a * (f2 * (1 - OUTSIDE * u) * (1 + e9) - r2 * (1 + e10)) * (1 + e11) * (1 + e12);
of_one = a * (f2 * (1 - OUTSIDE * u) * (1 + e9)) * (1 + e11) * (1 + e12);
of_r2 = a * (1 + e10) * (1 + e11) * (1 + e12);
b_off = (1 + e1) * (1 + e6) * (1 + e7) * (1 + e8) - 1;
right_lost = 3 * |b_off| + u;

behind = (1 + e10) / ((1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) * (1 - BEHIND * u) * (1 + e9));

quotient = (1 + e9) / a;
g = b0 * (quotient - 1) + b1 * quotient;
t = b0 + g;
h_E = |e1| + |t * e10|;
h_1 = |e11|;

off_1 = 2 * (h_1 * 1.001) + h_1 * h_1 * 4 + |e2| + |e3|;
off_E = 2 * h_E + 4 * h_1 * (|g| + h_E) + 4 * h_1;
off_EE = g * g + 2 * |g| * (h_E + h_1) + 3 * h_E * h_E;
rounding = (1 + e4) * (1 + e5) * (1 + e6) * (1 + e7) - 1;
bound = BOUND * u * (1 + k1) * (1 + k2) * (1 + k3) * (1 + k4) * (1 + k5) * (1 + k6) * (1 + k7) * (1 + k8) * (1 - 4 * u);

{ r2 in [0, 1] /\ |b0| <= 1 /\ |b1| <= 5b-53
  /\ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53
  /\ |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53
  /\ |k1| <= 1b-53 /\ |k2| <= 1b-53 /\ |k3| <= 1b-53 /\ |k4| <= 1b-53
  /\ |k5| <= 1b-53 /\ |k6| <= 1b-53 /\ |k7| <= 1b-53 /\ |k8| <= 1b-53
  ->
  left - (of_one - r2 * of_r2) in [0, 0]
  /\ of_one - 1 <= -40b-53 /\ |of_r2 - 1| <= 7b-53 /\ right_lost <= 14b-53
  /\ behind >= 1
  /\ bound - off_1 >= 0 /\ bound - off_E >= 0 /\ bound * SECOND * u - off_EE >= 0
  /\ bound - |rounding| >= 0 }

left - (of_one - r2 * of_r2) -> 0;
