"""Generator of extremes.csv: corners of the parameter range of the limiting shape, by mpmath with 90 digits and more:
python3 extremes.py > extremes.csv

Eq. (9) as Gauss's series, dv and the largest depth from it, the roots by bisection on the exact function. Inputs are binary64 values.
"""
import itertools
from mpmath import mp, mpf, gamma, sin, pi, exp, expm1, log, log1p, hyp2f1

mp.dps = 90

def shape(n, k, q):
    # next to full sliding the bracket's upper end differs from the root by (c/a0)^(1+k) or so
    mp.dps = 60
    mp.dps = 90 + int(2.2*float(-log1p(-mpf(q))/n)/2.3)
    n, k, q = mpf(n), mpf(k), mpf(q)
    m, mu, nu = n/2, (1-k)/2, (1+k)/2
    kappa = gamma(1+m)*gamma(nu)/gamma(m+nu)
    eta = -log1p(-q)/n

    def incomplete(a, b, L):
        """I_y(a, b), y = 1 - exp(-2L)"""
        z = exp(-2*L); y = -expm1(-2*L)
        pre = y**a*z**b*gamma(a+b)/(gamma(a)*gamma(b))
        if y < mpf(1)/2:
            return pre*hyp2f1(a+b, 1, a+1, y)/a
        return 1 - pre*hyp2f1(a+b, 1, b+1, z)/b

    def depth(b, L=None):
        L = b + eta if L is None else L
        return incomplete(mu, nu, L) - exp(n*b)/kappa*incomplete(mu, nu+m, L)

    def slope(L):
        b = L - eta
        z = exp(-2*L); y = -expm1(-2*L)
        S = sin(pi*mu)/(pi*mu)
        return 2*mu*S*y**(mu-1)*z**nu*q - n*exp(n*b)/kappa*incomplete(mu, nu+m, L)

    def root(f, lo, hi):
        """Secant steps guarded by bisection (Illinois), to 30 digits."""
        flo, fhi = f(lo), f(hi)
        assert flo > 0 > fhi, (flo, fhi)
        side = 0
        for i in range(2000):
            x = (lo*fhi - hi*flo)/(fhi - flo) if i % 4 != 3 else (lo+hi)/2
            fx = f(x)
            if fx > 0:
                lo, flo = x, fx
                if side == 1: fhi /= 2
                side = 1
            else:
                hi, fhi = x, fx
                if side == -1: flo /= 2
                side = -1
            if abs(hi-lo) < mpf(10)**-30*abs(hi) or fx == 0:
                return x
        raise RuntimeError

    small = min(mu*eta*mpf('1.02'), log(kappa)/n)
    hi = small if depth(small) < 0 else log(kappa)/n
    g = root(depth, mpf(0), hi)
    # deepest: between c, where the slope is infinite, and a_inf, in the logarithm of ln(r/c)
    deep = exp(root(lambda l: slope(exp(l)), log(g + eta) - 1200, log(g + eta)))
    A = exp(2*g); L = g + eta
    dv = A*incomplete(1+mu, nu, L) - A**(1+m)/(kappa*(1+m))*incomplete(1+mu, nu+m, L)
    c = exp(-eta)
    # c is formed as a0 e^-eta; widths without cancellation
    return dict(c=c, ainf_c=c*expm1(L), ainf_a0=expm1(g), dv=dv, max_df=depth(deep - eta, deep), r_max_minus_c=c*expm1(deep))

if __name__ == '__main__':
    print('n,k,q,c_over_a0,a_inf_minus_c_over_a0,a_inf_minus_a0_over_a0,dv_over_pi_a0sq_d,max_df_over_d,r_max_minus_c_over_a0')
    s = lambda v: mp.nstr(v, 17, min_fixed=0, max_fixed=0)
    rows = list(itertools.product([0.1, 1.0, 20.0], [-0.9999, -0.9, 0.0, 0.9, 0.9999], [1e-10, 0.5, 1-1e-10]))
    rows += list(itertools.product([0.3, 2.0, 6.5], [-0.9999, 0.5, 0.9999], [1e-10, 1e-5, 0.999, 1-1e-10]))
    for n, k, q in rows:
        r = shape(n, k, q)
        print(','.join([repr(n), repr(k), repr(q)] + [s(r[x]) for x in ('c','ainf_c','ainf_a0','dv','max_df','r_max_minus_c')]), flush=True)
