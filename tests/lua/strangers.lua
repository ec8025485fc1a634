-- Runs scripts of strangers in a dinal of their own, many at once, for the tests of safe mode and of limits.

local strangers = {}

local at_once = 8 -- most of them only wait for the end of their time

local function start(code, options, folder)
    local script, output = temporary ".lua", temporary()
    write(script, code)
    -- The limit is one of processor time: a machine that does other work must not decide.
    local run = ('cd "%s" && (ulimit -t 20; exec "%s" %s "%s") </dev/null >"%s" 2>&1; echo "exit $?" >>"%s"'):format(
        folder, program(), options, script, output, output)
    return { command = "( " .. run .. " ) &", output = output, script = script }
end

--- Runs each of the scripts; found[name] = { exit = code, text = what it printed }. The folder is where they run.
function strangers.run(scripts, options, folder)
    local found, waiting = {}, {}
    local function finish()
        local commands = {}
        for _, process in pairs(waiting) do
            commands[#commands + 1] = process.command
        end
        os.execute(table.concat(commands, "\n") .. "\nwait")
        for name, process in pairs(waiting) do
            local text, exit = read(process.output):match "^(.*)exit (%d+)\n$"
            found[name] = { exit = tonumber(exit), text = text:gsub(process.script:gsub("%p", "%%%0"), "script") }
        end
        waiting = {}
    end
    local count = 0
    for name, code in pairs(scripts) do
        waiting[name] = start(code, options, folder or ".")
        count = count + 1
        if count % at_once == 0 then
            finish()
        end
    end
    finish()
    return found
end

--- One test for each script: it must end with the exit code and print what the pattern matches, all of it.
function strangers.check(scripts, options, exit, pattern, folder)
    for name, result in pairs(strangers.run(scripts, options, folder)) do
        test(name, function()
            if result.exit ~= exit or not result.text:find("^" .. pattern .. "$") then
                error(("it ended with %s and printed: %s"):format(result.exit, result.text:sub(1, 1000)), 0)
            end
        end)
    end
end

return strangers
