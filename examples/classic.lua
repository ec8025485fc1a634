-- The dialogue of 1989: the program DINAL as its users met it. Eight numbers, then tmax and deltat, and a record of
-- six columns on "unit 13" (for013.dat in the current folder), computed by the integrator of 1989.
--
-- One thing is better: M*(t) is typed here, as a Lua expression, where the Fortran had to be edited and compiled
-- again. As in the listing t is the time in the units of I and k, not in T0, and M(t) = Mc M*(t).
--
--     dinal classic.lua                  asks, and asks again when something is wrong
--     dinal classic.lua < answers.txt    reads the answers; something wrong ends it with exit code 1
--
-- Numbers are separated by blanks or commas and may go on in the next line, as for READ(*,*).

local interactive = os.execute("test -t 0") or false

local function give_up(sentence)
  io.stderr:write("classic: ", sentence, "\n")
  os.exit(1, true)
end

local function next_line(what)
  io.stdout:flush()
  return io.read("l") or give_up("the input ended where " .. what .. " should be")
end

-- Asks until `accept` is content with what `read` has read: accept returns its result, or nil and a sentence.
local function ask(prompt, read, accept)
  while true do
    print(" " .. prompt .. "\n")
    local answer, sentence = read()
    if answer then
      local result
      result, sentence = accept(answer)
      if result then return result end
    end
    if not interactive then give_up(sentence) end
    print(" " .. sentence .. "\n")
  end
end

local function to_number(word)
  return tonumber((word:gsub("^([-+%d.]+)[dD]([-+%d]+)$", "%1e%2"))) -- 1.5D-3, as Fortran writes it
end

-- `count` numbers from one line or more.
local function numbers(count)
  return function()
    local list = {}
    while #list < count do
      for word in next_line(("number %d of %d"):format(#list + 1, count)):gmatch("[^%s,]+") do
        list[#list + 1] = to_number(word)
        if not to_number(word) then return nil, ("'%s' is not a number: enter %d numbers"):format(word, count) end
      end
    end
    if #list > count then return nil, ("%d numbers where %d are expected: enter %d"):format(#list, count, count) end
    return list
  end
end

-- A failing call's message without the line of this file in front.
local function try(f, ...)
  local ok, result = pcall(f, ...)
  if ok then return result end
  return nil, (tostring(result):gsub("^[^\n]-classic%.lua:%d+: ", ""))
end

-- Fw.d: stars when the number does not fit.
local function F(width, decimals, value)
  local text = string.format("%" .. width .. "." .. decimals .. "f", value)
  if #text > width or value ~= value or math.abs(value) == math.huge then return string.rep("*", width) end
  return text
end
local function print_fields(fields)
  local list = {}
  for i, field in ipairs(fields) do
    list[i] = field[1] .. "=" .. F(7, 3, field[2])
  end
  print(" " .. table.concat(list, "   ") .. "\n")
end

-- The system --------------------------------------------------------------------------------------------------------

local case = ask("Entrar I,k,c,Rd,Re,Ang.inic,Vel.inic,Mc", numbers(8), function(n)
  local sys, sentence = try(system, { I = n[1], k = n[2], C = n[3], Rd = n[4], Re = n[5] })
  if not sys then return nil, sentence end
  local Mc = n[8]
  if Mc == 0 then Mc = sys:characteristic_torque(n[6], n[7]) end
  if Mc == 0 then return nil, "Mc = 0 means k sqrt(theta0^2 + (velocity0/w0)^2), which is 0 here: enter an Mc" end
  for _, number in ipairs{ n[6], n[7], Mc } do
    if math.abs(number) == math.huge then return nil, "Ang.inic, Vel.inic and Mc must be finite" end
  end
  return { sys = sys, theta0 = n[6], velocity0 = n[7], Mc = Mc }
end)
local sys, theta0, velocity0, Mc = case.sys, case.theta0, case.velocity0, case.Mc
local zita = sys:friction_ratio(Mc)

print_fields{ { "I", sys.I }, { "k", sys.k }, { "c", sys.C }, { "Rd", sys.Rd }, { "Re", sys.Re },
  { "w0", sys.omega0 }, { "T0", sys.T0 }, { "DZETA", sys.zeta } }
print_fields{ { "ZITA", zita }, { "ang.inic", theta0 }, { "vel.inic", velocity0 }, { "Mc", Mc } }

-- The report's bound on the step. A start at rest in the middle has no VMAX; the Fortran divided by zero.
local vmax = math.sqrt((sys.omega0 * theta0)^2 + velocity0^2)
local deltatmax = sys.T0 * (sys.zeta + (zita > 0 and zita / vmax or 0))
print((" tsup=%s   deltatmax=%s\n"):format(F(10, 3, 10000 * deltatmax), F(7, 4, deltatmax)))

-- The window ----------------------------------------------------------------------------------------------------------

local window = ask("Entrar tmax,deltat", numbers(2), function(n)
  local tmax, deltat = n[1], n[2]
  if not (tmax > 0 and tmax < math.huge) then return nil, ("tmax = %g: it must be positive"):format(tmax) end
  if not (deltat > 0 and deltat <= tmax) then
    return nil, ("deltat = %g: it must be positive and at most tmax = %g"):format(deltat, tmax)
  end
  local npunt = math.floor(tmax / deltat * (1 + 2^-24) + 2) -- JINT cuts off; 0.3/0.1 was 3 in single precision
  if npunt > 1e8 then return nil, ("tmax/deltat asks for %.3g rows: enter a larger deltat"):format(npunt) end
  return { npunt = npunt, deltat = deltat }
end)

-- The excitation and the run ------------------------------------------------------------------------------------------

-- sin, exp, pi ... without "math.", capitals and ** as in Fortran: SIN(6.28*T)**2 will do
local names = setmetatable({}, { __index = function(_, name) return math[name] or _G[name] end })
local function compile(text)
  local expression = text:lower():gsub("%*%*", "^")
  if not expression:find("%S") then expression = "0" end
  local valid, message = load("return " .. expression, "=M*(t)", "t", names)
  if not valid then
    return nil, message:gsub("^M%*%(t%):%d+", "M*(t)") .. ": enter an expression in t like sin(2*pi*t)"
  end
  return load("return function(t) return " .. expression .. "\n end", "=M*(t)", "t", names)()
end

local run = ask("Entrar M*(t): expresion de Lua, t en la unidad de tmax, M = Mc M*; p.ej. sin(6.28*t); libre: 0",
  function() return next_line("M*(t)") end,
  function(text)
    local m, sentence = compile(text)
    if not m then return nil, sentence end
    local ok, first = pcall(m, 0)
    if not ok then return nil, first end
    if type(first) ~= "number" then return nil, ("M*(0) is a %s, not a number"):format(type(first)) end
    return try(sys.simulate, sys, {
      M = function(t) return Mc * m(t) end,
      theta0 = theta0,
      velocity0 = velocity0,
      t_end = (window.npunt - 1) * window.deltat,
      dt = window.deltat,
      integrator = integrator.dinal1989{ h = window.deltat },
    })
  end)

local saved, sentence = pcall(run.save, run, "for013.dat")
if not saved then give_up(sentence) end
print(" for013.dat: NPUNT = " .. #run)
print(" " .. tostring(run))
