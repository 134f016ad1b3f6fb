# Where rays leave a surface (Interaction::new, Interaction::start): a start lies on its own side of the
# exact plane, and of the exact sphere whose point was moved onto it.
#
# from src/render/ray.rs: const OFFSET: f64 = {OFFSET};
#
# All is divided by the exact size sum |n|(|p| + |a|) + extent; p, a and x are its three parts, with the
# computed point p and the computed unit normal n. A sum of |n||p| times roundings of single coordinates
# is p times one rounding, their weighted mean. Along the normal:
# - a point moved onto a plane is off by the rounding of its last sum, p * e1, and by what the move k is
#   wrong, k * m: one rounding each of distance, square, quotient and product, and one more for the part of the
#   distance that is not compensated. k is the error of the point on the ray. It is taken to be at most
#   a fourth of the size: so it is unless the origin is some 2^50 times as far as the size, when the
#   surface is no more than a point.
# - a point moved onto a sphere is off by p * e1 too, and by r = radius * (the length of n, and the product):
#   a square, two sums and a root, a quotient, then the product: six roundings of x.
#   The shares p and x make at most the whole, so it is enough that the step exceeds each as if it were all.
# The step has a product, the sum with the way back, which leads to the same side, and the last sum, that
# rounds the start: p * e2, at most the size times e2, and little of the offset itself. The length of n is within 5 roundings of 1.
OFFSET = 8;
u = 1b-53;

size = (1 + g1) * (1 + g2) * (1 + g3) * (1 + g4) * (1 + g5);
offset = OFFSET * u * size * (1 + g6);
step = offset * (1 + n) * (1 + n) * (1 + g7) * (1 + g8);
last = (1 + 2 * offset) * e2;
plane = e1 + k * ((1 + m1) * (1 + m2) * (1 + m3) * (1 + m4) * (1 + m5) - 1);
radius = (1 + m1) * (1 + m2) * (1 + m3) * (1 + m4) * (1 + m5) * (1 + m6) - 1;

{ |k| <= 0.25 /\ |n| <= 5b-53
  /\ |e1| <= 1b-53 /\ |e2| <= 1b-53
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-53 /\ |g3| <= 1b-53 /\ |g4| <= 1b-53
  /\ |g5| <= 1b-53 /\ |g6| <= 1b-53 /\ |g7| <= 1b-53 /\ |g8| <= 1b-53
  /\ |m1| <= 1b-53 /\ |m2| <= 1b-53 /\ |m3| <= 1b-53 /\ |m4| <= 1b-53 /\ |m5| <= 1b-53 /\ |m6| <= 1b-53
  ->
  step - |plane| - |last| >= 4b-53
  /\ step - |e1| - |last| >= 0
  /\ step - |radius| - |last| >= 0 }
