-- The dialogue of 1989: derived values, the record, and what wrong answers lead to.
--
--     dinal classic_test.lua PROGRAM EXAMPLES

local program, examples = arg[1], arg[2]
local function quoted(text) return "'" .. text:gsub("'", "'\\''") .. "'" end
local script = quoted(program) .. " " .. quoted(examples .. "/classic.lua")

local folder = os.tmpname()
os.remove(folder)
assert(os.execute("mkdir " .. quoted(folder)))
local function path(name) return folder .. "/" .. name end
local function read(name)
  local file = io.open(path(name), "rb")
  if not file then return nil end
  local text = file:read("a")
  file:close()
  return text
end

-- Answers go in; what is printed, the sentence of a failure and the exit code come out.
local function answer(text, command)
  os.remove(path("for013.dat"))
  local file = assert(io.open(path("answers"), "w"))
  file:write(text)
  file:close()
  local _, _, code = os.execute(("cd %s && %s <answers >out 2>err"):format(quoted(folder), command or script))
  return read("out"), read("err"), code
end
local function contains(text, part)
  assert(text:find(part, 1, true), ("%q is not in:\n%s"):format(part, text))
end

-- Figure 22 with deltat = 0.001, as it was typed
do
  local out, err, code = answer("1 39.48 0 6.59316 6.59316 0 6.283311 0\n3,0.001\n0\n")
  assert(code == 0 and err == "", err)
  contains(out, " Entrar I,k,c,Rd,Re,Ang.inic,Vel.inic,Mc\n")
  contains(out, " I=  1.000   k= 39.480   c=  0.000   Rd=  6.593   Re=  6.593   w0=  6.283   T0=  1.000"
    .. "   DZETA=  0.000\n")
  contains(out, " ZITA=  0.167   ang.inic=  0.000   vel.inic=  6.283   Mc= 39.480\n")
  contains(out, " tsup=   265.778   deltatmax= 0.0266\n") -- T0 0.167/6.283311 = 0.0265778
  contains(out, " Entrar tmax,deltat\n")
  -- NPUNT = nint(3/0.001 + 2) rows: the last one a deltat after tmax, as in 1989
  local text = read("for013.dat")
  assert(tonumber(text:match("^%s*(%d+)%s*\n")) == 3002)
  local record = load(path("for013.dat"))
  assert(#record == 3002 and math.abs(record.t[#record] - 3.001) < 1e-12)
  -- the true rest is at 0.155151; one step of 0.001 T0 before a stop at acceleration 4 pi^2 (0.167 + 0.178) is 1e-5
  assert(math.abs(record.theta[#record] - 0.155151392) < 1e-3, record.theta[#record])
  assert(math.abs(record.theta:max() - 0.846848608) < 1e-4)
end

-- Blanks, commas, several lines, an exponent of Fortran; M* in capitals with the 6.28 of the listing
do
  local out, err, code = answer("1.D0, 39.48\n 0 ,6.6\n6.6  1 0\n39.48\n2 1d-2\nSIN(6.28*T)\n")
  assert(code == 0 and err == "", err)
  contains(out, "Mc= 39.480")
  local record = load(path("for013.dat"))
  assert(#record == 202)
  assert(math.abs(record.M_over_k[26] - math.sin(6.28 * 0.25)) < 1e-12) -- M = Mc M*, t in time units
  assert(math.abs(record.friction_over_k[3] - 6.6 / 39.48) < 1e-12)     -- falls from 1: friction pushes upwards
end

-- t is time, not t/T0, and M* is scaled by Mc: T0 = 2 here
do
  local _, err, code = answer("4 39.4784176 0 0 0 0 0 10\n4 0.01\nt\n")
  assert(code == 0, err)
  local record = load(path("for013.dat"))
  assert(math.abs(record.M_over_k[101] - 10 * 1 / 39.4784176) < 1e-12)
end

-- A number that does not fit F7.3 is shown as stars, as Fortran does
do
  local out = answer("1 3948 0 0 0 1 0 0\n1 0.01\n0\n")
  contains(out, "k=*******")
end

-- What is wrong is said in one sentence on stderr, with exit code 1 and no record
for input, sentence in pairs{
  ["1 39.48 0 0 0 x 0 0\n"] = "'x' is not a number: enter 8 numbers",
  ["1 39.48 0 0 0 1\n"] = "the input ended where number 7 of 8 should be",
  ["1 39.48 0 0 0 1 0 0 5\n"] = "9 numbers where 8 are expected",
  ["-1 39.48 0 0 0 1 0 0\n"] = "I",
  ["1 39.48 0 2 1 1 0 0\n"] = "Re",
  ["1 39.48 0 0 0 0 0 0\n"] = "Mc = 0",
  ["1 39.48 0 0 0 1 0 0\n0 0.1\n"] = "tmax = 0",
  ["1 39.48 0 0 0 1 0 0\n1 -0.1\n"] = "deltat = -0.1",
  ["1 39.48 0 0 0 1 0 0\n1 1e-12\n"] = "enter a larger deltat",
  ["1 39.48 0 0 0 1 0 0\n1 0.1\nsin(\n"] = "M*(t)",
  ["1 39.48 0 0 0 1 0 0\n1 0.1\n'a'\n"] = "M*(0) is a string",
  ["1 39.48 0 0 0 1 0 0\n1 0.1\nsqrt(0.5-t)\n"] = "must return a finite number",
  ["1 39.48 0 0 0 1 0 0\n1 0.1\n"] = "the input ended where M*(t) should be",
} do
  local _, err, code = answer(input)
  assert(code == 1, ("exit code %s after %q"):format(code, input))
  contains(err, sentence)
  assert(err:find("^classic: [^\n]+\n$"), ("not one sentence after %q: %s"):format(input, err))
  assert(not read("for013.dat"), "a record was written")
end

-- At a terminal it asks again (script(1) gives it one).
if os.execute("command -v script >/dev/null") then
  local typed = "1 39.48 0 0 0 one 0 0\n1 39.48 0 0 0 1 0 0\n0 0\n1 0.1\nsin(\n0\n"
  local out, _, code = answer(typed, ("script -qec %s /dev/null"):format(quoted(script)))
  assert(code == 0, out)
  contains(out, "'one' is not a number")
  contains(out, "tmax = 0")
  contains(out, "NPUNT = 12")
end

os.execute("rm -r " .. quoted(folder))
