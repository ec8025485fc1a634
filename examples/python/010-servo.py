"""010: a servo with dry friction. SciPy finds the gains of its controller.

A motor turns a load by one radian. Friction stops it short of its goal unless the gain is high; a high gain rings. The
cost is the mean error over two seconds plus the one that is left at the end.
"""

import dinal
import numpy as np
from scipy.optimize import minimize

servo = dinal.system(I=0.02, k=0, C=0.05, Rd=0.8, Re=1.0)
MOST = 12.0  # N m, what the motor can give


def respond(gains):
    proportional, damping = gains
    return servo.simulate(
        M=lambda t, theta, velocity: min(max(proportional * (1 - theta) - damping * velocity, -MOST), MOST),
        t_end=2, dt=0.01)


def cost(gains):
    error = np.abs(1 - respond(gains).theta)
    return error.mean() + 5 * error[-1]


def tell(name, gains):
    run = respond(gains)
    print(f"{name}: kp = {gains[0]:.0f}, kd = {gains[1]:.1f}, overshoot {max(run.theta.max() - 1, 0):.3f}, "
          f"left at the end {abs(1 - run.theta[-1]):.3f} rad, cost {cost(gains):.2f}")


guess = [20, 0.5]
tell("by guess", guess)
best = minimize(cost, guess, method="Nelder-Mead", bounds=[(1, 200), (0, 10)], options={"maxfev": 40})
run = respond(best.x)
print(f"SciPy found gains of less than 0.7 times the cost: {best.fun < 0.7 * cost(guess)}")
print(f"the load ends within 0.02 rad of its goal: {abs(1 - run.theta[-1]) < 0.02}, and sticks there: "
      f"{'stick' in run.events.kind or 'rest' in run.events.kind}")

# prints
# by guess: kp = 20, kd = 0.5, overshoot 0.164, left at the end 0.012 rad, cost 0.10
# SciPy found gains of less than 0.7 times the cost: True
# the load ends within 0.02 rad of its goal: True, and sticks there: True
