"""030: a Monte Carlo. Where does a clutch lever come to rest when its friction is known to 20 % only?

Thousands of runs from a loop of Python, as NumPy draws the systems; then the same by a sweep, where a Lua function runs on
all cores.
"""

import dinal
import numpy as np

chance = np.random.default_rng(1989)
frictions = 0.3 * (1 + 0.2 * chance.uniform(-1, 1, 2000))

ends = np.array([dinal.system(I=1, k=4, Rd=Rd).simulate(theta0=1, t_end=30, times=[0, 30]).theta[-1] for Rd in frictions])
print(f"rest between {ends.min():+.3f} and {ends.max():+.3f} rad; dead zone of the mean friction: ±{0.3 / 4:.3f}")
print(f"{100 * np.mean(ends > 0):.0f} % end on the side on which they began")

point = dinal.lua("""function(p)
    return { theta = system{ I = 1, k = 4, Rd = p.Rd }:simulate{ theta0 = 1, t_end = 30, times = { 0, 30 } }.theta[2] }
end""")
swept = dinal.sweep(over={"Rd": frictions}, run=point)
print("the sweep has the same results:", np.array_equal(swept.theta, ends))

# prints
# rest between -0.080 and +0.077 rad; dead zone of the mean friction: ±0.075
# 50 % end on the side on which they began
# the sweep has the same results: True
