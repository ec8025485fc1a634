-- 190: the story of a run. What happened, when, where and why, in sentences: run:explain().

-- A push, and dry friction alone (figure 22 of the report).
local sys = nondimensional{ friction_ratio = 0.167 }
print(sys:simulate{ velocity0 = 2 * math.pi, t_end = 5, dt = 0.01 }:explain())
print()

-- Five times the friction, driven at resonance (figure 24): it stops in every half cycle. Of a long run the first and
-- the last stops are told, and what became of the motion.
sys = nondimensional{ friction_ratio = 0.836 }
local run = sys:simulate{ M = excitation.harmonic{ frequency = 1 }, theta0 = 1, t_end = 20, dt = 0.01 }
print(run:explain())

-- It is a string, so a script can search many runs.
print()
for _, ratio in ipairs{ 0.2, 0.4, 0.6, 0.8 } do
  local story = nondimensional{ friction_ratio = ratio }:simulate{
    M = excitation.harmonic{ frequency = 0.2 }, t_end = 200, dt = 0.05 }:explain():gsub("\n", " ")
  print(ratio, story:match("It stops [^.]*") or story:match("It does not stop[^.]*"))
end

--[[ prints
The system has T0 = 1, zeta = 0 (undamped) and dry friction Rd = Re = 0.167.
Units: theta in Mc/k, t in T0, M in Mc. There is no M: the motion is free.
The mass started at t = 0 from theta = 0 with velocity 6.2832.
It made 4 half cycles with 3 turns and 1 stop; it was stuck for 3.2763 of 5 T0
(65.5 %). It turned at theta = 0.84685 (t = 0.22366), -0.51285 (t = 0.72366),
0.17885 (t = 1.2237). Each extreme is 2 Rd/k = 0.334 smaller than the one
before: under dry friction the amplitude falls linearly, so the motion ends.
It stopped at t = 1.7237 at theta = 0.15515 because
|M - k theta| = 0.15515 <= Re = 0.167. M is constant from then on, so it stays
at rest.

The system has T0 = 1, zeta = 0 (undamped) and dry friction Rd = Re = 0.836.
Units: theta in Mc/k, t in T0, M in Mc. M has the period 1 (1 T0).
The mass started at t = 0 from theta = 1 with velocity 0 and moved off because
|M - k theta| = 1 > Re = 0.836.
It made 40 half cycles with 1 turn and 39 stops; it was stuck for 6.0645 of 20
T0 (30.3 %). It turned at theta = -0.89522 (t = 0.9988).
It stopped at t = 0.052203 at theta = 0.99708 because
|M - k theta| = 0.67492 <= Re = 0.836; it stuck for 0.42205, until this torque
exceeded Re and it slipped backward.
It stopped at t = 1.5 at theta = 0.79402 because
|M - k theta| = 0.79376 <= Re = 0.836; it stuck for 0.0067246, until this
torque exceeded Re and it slipped backward.
... 35 more ...
It stopped at t = 19.4502 at theta = 0.12917 because
|M - k theta| = 0.17877 <= Re = 0.836; it stuck for 0.17476, until this torque
exceeded Re and it slipped backward.
It stopped at t = 19.9502 at theta = -0.12917 because
|M - k theta| = 0.17877 <= Re = 0.836, and was still stuck when the run ended
at t = 20.
From t = 9.4502 on the motion is steady: it repeats itself every 1 (the period
of M). The amplitude is 0.12917 about theta = 0. The fundamental of theta lags
behind that of M by 2.002 rad. It stops twice in each period and is stuck for
35 % of the time.

0.2	It stops twice in each period and is stuck for 27
0.4	It stops 4 times in each period and is stuck for 43
0.6	It stops twice in each period and is stuck for 67
0.8	It stops twice in each period and is stuck for 69
]]
