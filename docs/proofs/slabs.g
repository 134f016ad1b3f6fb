# A box against a ray in double precision (Slabs::meet): what a ray enters before it leaves is met.
#
# from src/render/accel/bounds.rs: const FAR_SCALE: f64 = 1.0 + 2.0 * ({ROUNDINGS} * U / (1.0 - {ROUNDINGS} * U));
#
# Where a ray enters an axis at t it is computed below t * entered, where it leaves at t above
# t * left: three roundings each, of the inverse, the difference and the product, and one as the far
# end grows. GROWN in f64 is 1 + 2^-50, that is 1 + 8 u. Roundings are factors 1 + e.
ROUNDINGS = 4;
u = 1b-53;
grown = 1 + 2 * ROUNDINGS * u;

entered = (1 + e1) * (1 + e2) * (1 + e3);
left = (1 + e4) * (1 + e5) * (1 + e6) * grown * (1 + e7);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53
  /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\ |e7| <= 1b-53
  -> left - entered >= 0 }
