#include "api/animate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "api/bodies.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "lua/options.hpp"
#include "lua/worker_state.hpp"
#include "plots/animation/scene.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

namespace animation = plots::animation;

constexpr double usual_seconds = 10;
constexpr double most_frames = 3000;

/// The requested part and speed, within the limits of a file.
animation::Take asked_take(const lua::Options& options, const AnimateOptions& asked, const motion::Run& run) {
    animation::Take take{.from = asked.from.value_or(run.t_start), .to = asked.to.value_or(run.t_stop)};
    if (!(take.from < take.to) || take.from < run.t_start || take.to > run.t_stop) {
        options.fail(asked.from ? "from" : "to",
                     "from = {:.6g} and to = {:.6g} must be times of the run, which goes "
                     "from {:.6g} to {:.6g}, one after the other",
                     take.from, take.to, run.t_start, run.t_stop);
    }
    take.seconds = asked.speed ? (take.to - take.from) / *asked.speed : usual_seconds;
    if (take.steps() > most_frames) {
        options.fail("speed",
                     "speed = {:.6g} makes an animation of {:.4g} s, {:.0f} s are the most: give a greater "
                     "speed, or a part of the run by from and to",
                     *asked.speed, take.seconds, most_frames / animation::Take::frames_per_second);
    }
    return take;
}

AnimationViewer animation_viewer = nullptr;

/// The velocity of the surface that the run slides on, or nullptr.
const model::Excitation* belt_of(const LuaRun& run) {
    const model::Excitation* belt = run.origin ? &run.origin->drive.belts[run.place()] : nullptr;
    return belt != nullptr && !belt->components().empty() ? belt : nullptr;
}

animation::Track asked_track(lua_State* L, const lua::Options& options, const RunHandle& run,
                             const animation::Take& take, const model::Units& units) {
    const model::Excitation* belt = belt_of(*run);
    const plots::RunData data{run, &run->result, alone(*run), units};
    RunCall call(L, *run);  // user functions may be called between the rows
    auto track = animation::track_of(data, belt, take, [] { return !lua::interrupt_requested(); });
    call.check();
    if (lua::interrupt_requested()) {
        lua::raise_interrupted(L);
    }
    return options.value_or_fail(std::move(track));
}

/// The scene of all bodies and the links between them, or of one body.
animation::Scene asked_scene(lua_State* L, const lua::Options& options, const RunHandle& run,
                             const animation::Take& take) {
    const model::Units units = asked_units(L, options).value_or(units_of(*run));
    if (!run->of_all()) return animation::scene_of({asked_track(L, options, run, take, units)}, {}, take.seconds);
    std::vector<animation::Track> bodies;
    std::vector<animation::Link> links;
    const model::System& system = run->system();
    for (const RunHandle& part : parts_of(run)) {
        const model::Joint& joint = system.joints[*part->joint];
        animation::Track track = asked_track(L, options, part, take, units);
        track.name = joint.name;
        if (system.is_link(*part->joint)) {
            links.push_back({std::move(track), joint.first(), joint.of.back().body});
        } else {
            bodies.push_back(std::move(track));
        }
    }
    // Without springs, angles belong to rotating parts, even if they turn little in this run.
    const bool angles = units.theta.empty() || units.theta == "rad";
    const auto links_begin = system.joints.begin() + static_cast<std::ptrdiff_t>(system.bodies.size());
    const bool is_free = std::all_of(system.joints.begin(), links_begin, [](const model::Joint& joint) {
        return joint.stiffness == 0 && joint.spring.none() && !joint.walls;
    });
    animation::Scene scene = animation::scene_of(std::move(bodies), std::move(links), take.seconds);
    scene.discs = angles && (scene.discs || is_free);
    return scene;
}

Animation drawn(lua_State* L, const lua::Options& options, const RunHandle& run, const AnimateOptions& asked) {
    const animation::Scene scene = asked_scene(L, options, run, asked_take(options, asked, run->result));
    return {animation::animated_svg(scene), animation::title_of(scene)};
}

}  // namespace

void show_animations_by(AnimationViewer viewer) {
    animation_viewer = viewer;
}

Animation animation_at(lua_State* L, int index) {
    const RunHandle run = lua::self<RunHandle>(L, index, report_animate_call.name);
    const lua::Options options(L, index + 1, report_animate_call);
    AnimateOptions asked;
    options.fill(asked);
    return drawn(L, options, run, asked);
}

int animate_run(lua_State* L) {
    lua::refuse_in_worker(L, "run:animate");
    const RunHandle run = lua::self<RunHandle>(L, 1, "run:animate()");
    const lua::Options options(L, 2, animate_call);
    AnimateOptions asked;
    options.fill(asked);
    if (!asked.file) {
        if (animation_viewer == nullptr) {
            options.fail({"a terminal does not show animations; give file = \"run.svg\", which a browser plays"});
        }
        animation_viewer(drawn(L, options, run, asked), Shown::here);
        return 0;
    }
    if (text::ending_of(*asked.file) != ".svg") {
        options.fail({.sentence = fmt::format("the name '{}' must end in .svg", *asked.file),
                      .option = "file",
                      .culprit = *asked.file});
    }
    files::OutputFile file = options.value_or_fail(files::OutputFile::create(*asked.file));
    const Animation animation = drawn(L, options, run, asked);
    file.write(animation.svg);
    options.value_or_fail(file.commit());
    if (animation_viewer != nullptr) animation_viewer(animation, Shown::in_file);
    return 0;
}

}  // namespace dinal::api
