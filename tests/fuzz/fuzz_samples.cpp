// excitation.samples of a file, and runs that are driven by it; the first byte says how.
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>

#include "fuzz/lua_runner.hpp"

namespace {
constexpr std::array<const char*, 5> ways{
    "local e = excitation.samples 'fuzz.csv' print(e, e(0), e:values{ -1, 0, 0.5, 1, 1e9 }) "
    "local run = nondimensional{ zeta = 0.1, friction_ratio = 0.1 }:simulate{ M = e, t_end = 2, dt = 0.1 } "
    "run:save 'run.csv' assert(load 'run.csv'.theta == run.theta) print(run:at(1.234))",
    "print(excitation.samples('fuzz.csv', { time = 't', value = 'M' }))",
    "print(excitation.samples('fuzz.csv', { time = '2', value = '1' }):delay(0.5)(1))",
    "local run = load 'fuzz.csv' print(run, #run, run:columns()) "
    "for _, name in ipairs(run.names) do print(run[name]) end "
    "run:save 'again.csv' assert(#load 'again.csv' == #run) print(run:at(0.5))",
    "local e = excitation.samples 'fuzz.csv' nondimensional{}:simulate{ M = e + 2 * e, t_end = 1, times = {}, "
    "integrator = integrator.dinal1989{ h = 0.01 } }"};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) {
        return 0;
    }
    run_stranger("");  // goes to the folder
    std::ofstream("fuzz.csv", std::ios::binary)
        .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
    run_stranger(ways.at(data[0] % ways.size()));
    return 0;
}
