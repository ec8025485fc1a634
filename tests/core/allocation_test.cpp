// The stepping loop allocates nothing: operator new of this test program counts.
#include <malloc.h>

#include <cstdlib>
#include <memory>
#include <new>

#include "support/catch.hpp"
#include "support/systems.hpp"

namespace {
thread_local long allocations = 0;
thread_local std::size_t bytes_held = 0;  // bytes, what was freed in another thread among it

void* counted(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) {
        bytes_held += malloc_usable_size(memory);
        return memory;
    }
    throw std::bad_alloc();
}

void give_back(void* memory) {
    if (memory != nullptr) bytes_held -= malloc_usable_size(memory);
    std::free(memory);
}
}  // namespace

// All forms but the over-aligned ones, so that no pair of new and delete is of mixed origin (AddressSanitizer looks).
void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    void* memory = std::malloc(size == 0 ? 1 : size);
    if (memory != nullptr) bytes_held += malloc_usable_size(memory);
    return memory;
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    void* memory = std::malloc(size == 0 ? 1 : size);
    if (memory != nullptr) bytes_held += malloc_usable_size(memory);
    return memory;
}
void operator delete(void* memory) noexcept {
    give_back(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    give_back(memory);
}
void operator delete[](void* memory) noexcept {
    give_back(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    give_back(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    give_back(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
    give_back(memory);
}

using namespace dinal;
using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

long allocations_of(const Oscillator& system, const Excitation& excitation, const Integrator& integrator,
                    double t_end) {
    column_names();  // made once, at first use
    const long before = allocations;
    const auto run = simulate(system, {excitation, {1, 0}}, {0, t_end}, Grid::none(), integrator);
    const long made = allocations - before;
    REQUIRE(run);
    return made;
}

class Constantly : public UserFunction {
public:
    double value(double t, const State& state) override { return 0.1 * t - 0.2 * state.velocity; }
};

std::vector<Integrator> both() {
    return {Rk4{0.001}, Dinal1989{.h = 0.001}};
}

}  // namespace

TEST_CASE("the counter counts allocations", "[allocation]") {
    const long before = allocations;
    const auto one = std::make_unique<int>(1);
    CHECK(*one == 1);
    CHECK(allocations == before + 1);
}

TEST_CASE("a run without rows makes as many allocations for a hundred thousand steps as for a hundred",
          "[allocation]") {
    const Oscillator critical = nondimensional(1, 0);  // one event at most
    const auto pulses = Excitation::make(Square{.amplitude = 1, .period = 3}).value() + harmonic(1, 2);
    for (const Integrator& integrator : both()) {
        CAPTURE(integrator.index());
        CHECK(allocations_of(critical, {}, integrator, 0.1) == allocations_of(critical, {}, integrator, 100));
        // Events grow their vector: by doubling, so that 200 of them take 8 allocations at most.
        const Oscillator sticking = nondimensional(0.05, 0.7);
        const long few = allocations_of(sticking, pulses, integrator, 0.1);
        CHECK(allocations_of(sticking, pulses, integrator, 30) <= few + 9);
        // A mass at rest for ever.
        const Oscillator held = nondimensional(0, 2);
        CHECK(allocations_of(held, harmonic(0.9, 2), integrator, 0.1) ==
              allocations_of(held, harmonic(0.9, 2), integrator, 100));
    }
}

TEST_CASE("a user's function costs no allocations either, with or without feedback", "[allocation]") {
    for (const bool feedback : {false, true}) {
        const auto scripted =
            Excitation::make(Scripted{.function = std::make_shared<Constantly>(), .feedback = feedback}).value();
        for (const Integrator& integrator : both()) {
            const Oscillator system = nondimensional(3, 0);
            CAPTURE(feedback, integrator.index());
            const long few = allocations_of(system, scripted, integrator, 0.5);
            CHECK(allocations_of(system, scripted, integrator, 50) <= few + 3);  // a turn may be recorded
        }
    }
}

TEST_CASE("a short run that is kept takes a few kilobytes", "[allocation]") {
    const Oscillator system = nondimensional(0.05, 0.1);
    const std::size_t before = bytes_held;
    const auto run = simulate(system, {{}, {1, 0}}, {0, 1}, Grid::every(0.5), Spectral{});
    const std::size_t taken = bytes_held - before;
    REQUIRE(run);
    REQUIRE(run->size() == 3);
    CHECK(taken <= 6300);  // three stretches of some 700 bytes each, the joint, and the run; malloc rounds up
}
