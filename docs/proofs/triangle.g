# The edge functions of a triangle in double precision (sure_sign): a sign that is told is that of the
# exact edge function of the sheared corners as they were computed, which triangles with that edge share.
#
# from src/render/shape/triangle.rs: let error = {ROUNDINGS} * U * (first.abs() + second.abs()) + f64::MIN_POSITIVE;
#
# a and b are the exact products, divided by the sum of their absolute values. A product that underflows is off by
# half the least subnormal number, which the 2^-1022 that is added exceeds by far. The shear itself rounds too: all
# triangles round a corner alike, so that opens no gap.
ROUNDINGS = 4;
u = 1b-53;

first = a * (1 + e1);
second = b * (1 + e2);
computed = (first - second) * (1 + e3);
off = a * (e1 + e3 + e1 * e3) - b * (e2 + e3 + e2 * e3);
bound = ROUNDINGS * u * (1 + e4) * (1 + e5) * (1 + e6) * (1 + e7);

{ |a| <= 1 /\ |b| <= 1
  /\ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53
  /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\ |e7| <= 1b-53
  ->
  computed - (a - b) - off in [0, 0]
  /\ bound - |e1 + e3 + e1 * e3| >= 0 /\ bound - |e2 + e3 + e2 * e3| >= 0 }

computed - (a - b) - off -> 0;
