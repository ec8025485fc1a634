"""020: which system made a record. pandas reads the CSV file, dinal fits friction and damping.

The file is made here, as a measurement might have left it: a noisy decay with a gap, in degrees.
"""

import os
import tempfile

import dinal
import numpy as np
import pandas

with tempfile.TemporaryDirectory() as folder:
    name = os.path.join(folder, "decay.csv")
    truth = dinal.system(I=0.5, k=40, C=0.15, Rd=0.4)
    run = truth.simulate(theta0=0.3, t_end=6, dt=0.01)
    noise = 0.001 * np.random.default_rng(1).standard_normal(len(run))
    record = pandas.DataFrame({"time": run.t, "angle": np.degrees(run.theta + noise)})
    record.loc[200:210, "angle"] = np.nan
    record.to_csv(name, index=False)

    record = pandas.read_csv(name)

record["theta"] = np.radians(record.angle)
fit = dinal.identify(data=record[["time", "theta"]], t="time", I=0.5)
for value, true in (("k", 40), ("C", 0.15), ("Rd", 0.4)):
    error = fit.std_error[value]
    print(f"{value:2} = {fit[value]:6.3f}, true {true:5.2f}, within three standard errors: "
          f"{abs(fit[value] - true) < 3 * error}")
print(f"noise {fit.noise:.4f} rad, {len(fit.residual)} samples")

# prints
# k  = 39.998, true 40.00, within three standard errors: True
# C  =  0.150, true  0.15, within three standard errors: True
# Rd =  0.400, true  0.40, within three standard errors: True
# noise 0.0009 rad, 590 samples
