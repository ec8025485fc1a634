// The threads of a sweep, each with a Lua state of its own into which the user's function was carried.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "api/sweep_results.hpp"
#include "lua/interrupt.hpp"
#include "lua/worker_state.hpp"

namespace dinal::api {

/// What the workers share.
struct SweepWork {
    const SweepGrid& grid;
    SweepResults& results;
    std::vector<std::size_t> points;  ///< to be done
    long long seed = 0;               ///< of math.random, with the number of the point
    const char* call = "sweep";       ///< heads sentences
    double max_time = 0;              ///< seconds of a point; 0: any
    /// In the state of a worker: replaces the carried function on the top by the one that is asked.
    const std::function<void(lua_State* worker)>& adapt;
    /// Asked 50 times a second on the thread that waits, and at the end: false ends it all.
    std::function<bool()> look = {};
    std::function<void()> after_point = {};  ///< where one thread does all
    std::atomic<std::size_t> next = 0;
    std::atomic<std::size_t> finished = 0;
    std::atomic<bool> ends = false;
    std::size_t workers = 1;
};

class SweepWorkers {
public:
    /// Carries the function at `index` to a new state for each worker. Raises when that is not possible. A function of
    /// another language stays where it is, and the thread of the call does all points.
    SweepWorkers(lua_State* L, int index, SweepWork& work);

    /// Does all points, or what can be done until a stop is requested. Raises when memory is lacking.
    void run(lua_State* L);

private:
    void run_here(lua_State* L);
    void start(std::vector<std::thread>& threads);
    void run_one(lua_State* worker, lua::WorkerWatch& watch);
    /// Gives up what has taken too long.
    void watch(std::vector<std::thread>& threads);

    SweepWork& work_;
    std::vector<lua::OwnedState> states_;
    std::deque<lua::WorkerWatch> watches_;  // of the threads
    std::mutex ending_;
    std::condition_variable ended_;
    std::size_t running_ = 0;
    std::string trouble_;
    int function_ = 0;  // on the stack, of another language; 0: it is in the states
};

}  // namespace dinal::api
