"""Limits under both forces held, of power laws, in mpmath with 60 digits: closed forms, the contact radius by a root search.

    F_N = 2 c_N ∫_0^c x^k (d - g0) dx,    w = d I_y(μ, ν) - r^n/κ I_y(μ, ν + n/2),  y = 1 - c²/r²

Lengths in a0 and d0, the radius and the depth of the first contact; `gap` = 1 - c/a0.
"""
import mpmath as mp

mp.mp.dps = 60

def row(k, n, gap):
    k, n, gap = mp.mpf(k), mp.mpf(n), mp.mpf(gap)
    c, q, mu, nu = 1 - gap, 1 + k, (1 - k) / 2, (1 + k) / 2
    kappa = mp.gamma(1 + n / 2) * mp.gamma(nu) / mp.gamma(nu + n / 2)
    d = q / c**q * (1 / q - 1 / (n + q) + c**(n + q) / (n + q))
    inc = lambda a, b, y: mp.betainc(a, b, 0, y, regularized=True)
    def depth(r):
        y = 1 - (c / r)**2
        return d * inc(mu, nu, y) - r**n / kappa * inc(mu, nu + n / 2, y)
    low, high = d**(1 / n), (kappa * d)**(1 / n)
    a = mp.findroot(depth, (low, high), solver="anderson", tol=mp.mpf(10)**-50)
    A = a**2
    Y = 1 - c**2 / A
    volume = mp.pi * (d * A * inc(1 + mu, nu, Y) - 2 / (n + 2) * A**(1 + n / 2) / kappa * inc(1 + mu, nu + n / 2, Y))
    return d - 1, a - 1, volume

print("k,n,gap,d_inf/d0-1,a_inf/a0-1,V_inf/(a0^2 d0)")
for k in ("-0.9", "-0.5", "0", "0.5", "0.95"):
    for n in ("1", "2", "4"):
        for gap in ("1e-6", "1e-3", "0.05", "0.3", "0.8", "0.99"):
            print(",".join([k, n, gap] + [mp.nstr(value, 17) for value in row(k, n, gap)]))
