# Edge functions of a triangle in single precision (TriangleLanes::hit_mask): what is computed is
# within `bound` of the exact edge function of the exact corners, so a sign beyond it is right.
#
# from src/render/accel/lanes.rs: size * (size * ({EDGE_ROUNDING} * f32::EPSILON) + error * {EDGE_ERROR});
#
# All is divided by size = m + error, with m the largest coordinate of the computed corners p and q,
# k = error / size. The exact corners P and Q are within k of them. A rounding is a factor 1 + e;
# a product that underflows is off by h besides: error is at least 2^-35, so size^2 is at least
# 2^-70, and half the least number of f32 is 2^-150.
EDGE_ROUNDING = 8;
EDGE_ERROR = 6;
u = 1b-24;

p0 = (1 - k) * a0; p1 = (1 - k) * a1;
q0 = (1 - k) * b0; q1 = (1 - k) * b1;
P0 = p0 + k * d0; P1 = p1 + k * d1;
Q0 = q0 + k * f0; Q1 = q1 + k * f1;

exact = P0 * Q1 - P1 * Q0;
computed = ((p0 * q1 * (1 + e1) + h1) - (p1 * q0 * (1 + e2) + h2)) * (1 + e3);
rounding = p0 * q1 * (e1 + e3 + e1 * e3) - p1 * q0 * (e2 + e3 + e2 * e3) + (h1 - h2) * (1 + e3);
corners = (p1 * f0 + d1 * q0 - p0 * f1 - d0 * q1) + k * (d1 * f0 - d0 * f1);

size = 1 + e4;
bound = (size * ((size * (2 * EDGE_ROUNDING * u)) * (1 + e5) + (k * EDGE_ERROR) * (1 + e6)) * (1 + e7)) * (1 + e8);
bound_of_rounding = size * size * (2 * EDGE_ROUNDING * u) * (1 + e5) * (1 + e7) * (1 + e8);
bound_of_corners = size * EDGE_ERROR * (1 + e6) * (1 + e7) * (1 + e8);

{ |a0| <= 1 /\ |a1| <= 1 /\ |b0| <= 1 /\ |b1| <= 1
  /\ |d0| <= 1 /\ |d1| <= 1 /\ |f0| <= 1 /\ |f1| <= 1 /\ k in [0, 1]
  /\ |h1| <= 1b-80 /\ |h2| <= 1b-80
  /\ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24
  /\ |e5| <= 1b-24 /\ |e6| <= 1b-24 /\ |e7| <= 1b-24 /\ |e8| <= 1b-24
  ->
  computed - exact - (rounding + k * corners) in [0, 0]
  /\ bound - (bound_of_rounding + k * bound_of_corners) in [0, 0]
  /\ |rounding| <= 5b-24 /\ bound_of_rounding >= 5b-24
  /\ |corners| <= 5 /\ bound_of_corners >= 5 }

computed - exact - (rounding + k * corners) -> 0;
bound - (bound_of_rounding + k * bound_of_corners) -> 0;
|corners| $ k in 64;
