#!/usr/bin/env python3
"""bearing.csv: a film on a pad that rocks on its pivot, seen from the shaft.

    K(w) + i w C(w) = 1/(1/(k1 + i w c1) + 1/(k2 - w^2 m2 + i w c2))

k1, c1: film at a speed; m2, k2, c2: the pad's inertia (as seen at the film) on its pivot."""
k2, m2, c2 = 4e8, 60.0, 1e4
with open("bearing.csv", "w") as out:
    out.write("speed[rpm],frequency[Hz],kyy[N/m],kzz[N/m],cyy[N.s/m],czz[N.s/m]\n")
    for rpm in (3000, 6000, 9000, 12000):
        k1, c1 = 6e7 + 6e3 * rpm, 8e4 - 2.0 * rpm
        for hz in range(10, 601, 10):
            w = 2 * 3.141592653589793 * hz
            d = 1 / (1 / complex(k1, w * c1) + 1 / complex(k2 - w * w * m2, w * c2))
            out.write(f"{rpm},{hz},{d.real:.10g},{d.real:.10g},{d.imag / w:.10g},{d.imag / w:.10g}\n")
