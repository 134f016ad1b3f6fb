#!/usr/bin/env python3
"""Prints the rows of src/tables/metal.rs that come from measured spectra.

    pip install mitsuba
    python3 benches/metals.py

Mitsuba 3 has the measured η and k of conductors over the wavelength (Palik, "Handbook of Optical
Constants of Solids", 1985, and the tables of SOPRA). A renderer in RGB cannot use the spectra; the
variant `scalar_rgb` integrates them times the colour matching functions of CIE 1931 and converts
the result to linear Rec. 709. These are the numbers that it computes, rounded to six digits.
"""

import mitsuba

NAMES = {
    "Ag": "silver",
    "Al": "aluminium",
    "Au": "gold",
    "Cr": "chromium",
    "Cu": "copper",
    "Ni_palik": "nickel",
    "W": "tungsten",
}
OTHERS = (
    "a-C AlAs AlSb Be CsI Cu2O CuO d-C Hg HgTe Ir K Li MgO Mo Na_palik Nb Rh Se SiC SnTe Ta Te "
    "ThF4 TiC TiN TiO2 VC V_palik VN"
).split()


def numbers(value):
    triple = ", ".join(f"{float(f'{channel:.6g}')!r}" for channel in value)
    return f"[{triple}]"


def main():
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    for symbol in sorted([*NAMES, *OTHERS]):
        bsdf = mitsuba.load_dict({"type": "conductor", "material": symbol})
        found = mitsuba.traverse(bsdf)
        name = NAMES.get(symbol)
        name = f'Some("{name}")' if name else "None"
        symbol = symbol.removesuffix("_palik")
        eta, k = (numbers(found[f"{part}.value"]) for part in ("eta", "k"))
        print(f'    metal("{symbol}", {name}, {eta}, {k}),')


if __name__ == "__main__":
    mitsuba.set_variant("scalar_rgb")
    main()
