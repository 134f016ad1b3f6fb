# Eight boxes against a conservative ray in single precision (BoxLanes::meet): what a ray enters before it leaves
# is met.
#
# from src/render/accel/conservative_ray.rs: let shift = (origin.abs() * ({SHIFT} * ROUND) + {BASE} * base).copysign(direction);
# from src/render/accel/lanes.rs: pub(in crate::accel) const FAR_SCALE: f32 = 1.0 + {GROWN} * f32::EPSILON;
#
# The origin o, shifted along the conservative ray and rounded, is more than base beyond o: base is what the conservative ray
# may be off by. So what is left to the near end of a box is less than it was, to the far end
# more; then each takes four roundings: of the direction, its inverse, the difference and the product.
# Where a ray enters an axis at t it is computed below t * entered, where it leaves at t above
# t * left. Roundings are factors 1 + e, those of f64 1 + g; side is 1 or -1, as o and the direction
# have one sign or two.
SHIFT = 4;
BASE = 2;
GROWN = 16;
u = 1b-24;

shift = (w * (SHIFT * u) + BASE * base) * (1 + g);
beyond = (side * w + shift) * (1 + e0) - side * w;
of_origin = SHIFT * u * (1 + g) * (1 + e0) + side * e0;
of_base = BASE * (1 + g) * (1 + e0);

entered = (1 + e2) * (1 + e3) * (1 + e4) / (1 + e1);
left = (1 + e6) * (1 + e7) * (1 + e8) / (1 + e5) * (1 + GROWN * 2 * u) * (1 + e9);

{ |side| <= 1 /\ |g| <= 1b-50 /\ |e0| <= 1b-24
  /\ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\ |e5| <= 1b-24
  /\ |e6| <= 1b-24 /\ |e7| <= 1b-24 /\ |e8| <= 1b-24 /\ |e9| <= 1b-24
  ->
  beyond - (w * of_origin + base * of_base) in [0, 0]
  /\ of_origin >= 0 /\ of_base >= 1
  /\ left - entered >= 0 }

beyond - (w * of_origin + base * of_base) -> 0;
