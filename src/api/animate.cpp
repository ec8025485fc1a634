#include "api/animate.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "api/bodies.hpp"
#include "api/picture.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/worker_state.hpp"
#include "plots/animation/scene.hpp"
#include "terminal/display.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

namespace animation = plots::animation;

constexpr double usual_seconds = 10;
constexpr double frames_per_second = 25;
constexpr double most_frames_in_file = 3000, most_frames = 100'000;

/// The requested part and speed, within the limits of a file or of memory.
animation::Take asked_take(const lua::Options& options, const AnimateOptions& asked, const motion::Run& run,
                           double most) {
    animation::Take take{.from = asked.from.value_or(run.t_start), .to = asked.to.value_or(run.t_stop)};
    if (!(take.from < take.to) || take.from < run.t_start || take.to > run.t_stop) {
        options.fail(asked.from ? "from" : "to",
                     fmt::format("from = {:.6g} and to = {:.6g} must be times of the run, which goes "
                                 "from {:.6g} to {:.6g}, one after the other",
                                 take.from, take.to, run.t_start, run.t_stop));
    }
    take.seconds = asked.speed ? (take.to - take.from) / *asked.speed : usual_seconds;
    take.frames_per_second = frames_per_second;
    if (take.count() > most) {
        options.fail("speed",
                     fmt::format("speed = {:.6g} makes an animation of {:.4g} s, {:.0f} s are the most: give a greater "
                                 "speed, or a part of the run by from and to",
                                 *asked.speed, take.seconds, most / frames_per_second));
    }
    return take;
}

AnimationViewer animation_viewer = nullptr;

/// The velocity of the surface that the run slides on, or nullptr.
const model::Excitation* belt_of(const LuaRun& run) {
    const model::Excitation* belt = run.origin ? &run.origin->drive.belts[run.place()] : nullptr;
    return belt != nullptr && !belt->components().empty() ? belt : nullptr;
}

animation::Scene asked_scene(lua_State* L, const lua::Options& options, const RunHandle& run,
                             const animation::Take& take, const model::Units& units) {
    const model::Excitation* belt = belt_of(*run);
    const plots::RunData data{run, &run->result, alone(*run), units};
    lua::CallState call(L);  // between rows the integrator evaluates the excitation
    auto scene = animation::scene_of(data, belt, take, [] { return !lua::interrupt_requested(); });
    call.check();
    if (lua::interrupt_requested()) {
        lua::raise_interrupted(L);
    }
    return options.value_or_fail(std::move(scene));
}

/// Writes the whole text; returns false if the output is closed.
bool show(std::string_view text) {
    while (!text.empty()) {
        const ssize_t count = ::write(STDOUT_FILENO, text.data(), text.size());
        if (count < 0 && errno != EINTR) return false;
        text.remove_prefix(count > 0 ? static_cast<std::size_t>(count) : 0);
        if (lua::interrupt_requested()) return false;
    }
    return true;
}

/// Plays in place in real time; late frames are dropped. Several scenes are drawn one below the other.
void play(const std::vector<animation::Scene>& scenes, const AnimateOptions& asked) {
    const animation::Scene& scene = scenes.front();
    using Clock = std::chrono::steady_clock;
    static_cast<void>(std::fflush(stdout));
    const auto began = Clock::now();
    const double count = static_cast<double>(scene.frames.size() - 1);
    int above = 0;  // number of lines of the frame before
    bool goes_on = show("\x1b[?25l");
    for (bool last = false; goes_on && !last;) {
        const double passed = std::chrono::duration<double>(Clock::now() - began).count();
        const double place = std::min(count, std::floor(passed / scene.seconds * count));
        last = place == count;
        const terminal::Display seen = terminal::display_of(STDOUT_FILENO);
        const animation::FrameFormat format{
            .columns = std::min(seen.columns - 1, 100),
            .charset = asked.ascii.value_or(!seen.draws) ? plots::Charset::ascii : plots::Charset::braille,
            .colours = seen.colour};
        std::string text = above > 0 ? fmt::format("\x1b[{}A", above) : "";
        above = 0;
        for (const animation::Scene& each : scenes) {
            const std::vector<std::string> lines =
                animation::text_frame(each, each.frames[static_cast<std::size_t>(place)], format);
            for (const std::string& line : lines) text += "\r" + line + "\x1b[K\n";
            above += static_cast<int>(lines.size());
        }
        goes_on = show(text) && !lua::interrupt_requested();
        const double next =
            (place + 1) / count * scene.seconds - std::chrono::duration<double>(Clock::now() - began).count();
        if (goes_on && !last) ::poll(nullptr, 0, std::clamp(static_cast<int>(1000 * next), 1, 1000));
    }
    constexpr std::string_view cursor = "\x1b[?25h";
    [[maybe_unused]] const ssize_t written = ::write(STDOUT_FILENO, cursor.data(), cursor.size());
}

/// A scene of all bodies and the links between them.
animation::RigScene asked_rig(lua_State* L, const lua::Options& options, const RunHandle& run,
                              const animation::Take& take, const model::Units& units) {
    std::vector<animation::Scene> bodies;
    std::vector<animation::RigScene::Link> links;
    const model::System& system = run->system();
    for (const RunHandle& part : parts_of(run)) {
        const model::Joint& joint = system.joints[*part->joint];
        animation::Scene scene = asked_scene(L, options, part, take, units);
        scene.name = joint.name;
        if (system.is_link(*part->joint)) {
            links.push_back({std::move(scene), joint.first(), joint.of.back().body});
        } else {
            bodies.push_back(std::move(scene));
        }
    }
    // Without a spring the angles belong to rotating parts, however far they turn in this run.
    const bool angles = units.theta.empty() || units.theta == "rad";
    const auto links_begin = system.joints.begin() + static_cast<std::ptrdiff_t>(system.bodies.size());
    const bool is_free = std::all_of(system.joints.begin(), links_begin, [](const model::Joint& joint) {
        return joint.stiffness == 0 && joint.spring.none() && !joint.walls;
    });
    animation::RigScene rig = animation::side_by_side(std::move(bodies), std::move(links));
    rig.discs = rig.discs || (angles && is_free);
    return rig;
}

/// The scenes for a terminal: rotation jumps back at half a turn.
std::vector<animation::Scene> one_below_the_other(const animation::RigScene& rig) {
    std::vector<animation::Scene> scenes = rig.bodies;
    for (animation::Scene& scene : scenes) {
        if (!rig.discs) continue;
        for (animation::Frame& frame : scene.frames) frame.theta = std::remainder(frame.theta, 2 * std::numbers::pi);
        scene.reach = {-std::numbers::pi, std::numbers::pi};
    }
    return scenes;
}

void refuse_no_terminal(const lua::Options& options) {
    const bool shown = terminal::display_of(STDOUT_FILENO).terminal;
    if (shown && terminal::obeys_escapes()) return;
    options.fail({fmt::format("an animation is shown in a terminal, and this {}; give file = \"run.svg\"",
                              shown ? "one cannot do it, as TERM says" : "output is none")});
}

/// Writes the file, unless the animation cannot be made.
template <class Make>
void write_animation(const lua::Options& options, const std::string& name, const Make& make) {
    if (text::ending_of(name) != ".svg") {
        options.fail(
            {.sentence = fmt::format("the name '{}' must end in .svg", name), .option = "file", .culprit = name});
    }
    files::OutputFile file = options.value_or_fail(files::OutputFile::create(name));
    const Animation drawn = make();
    file.write(drawn.svg);
    options.value_or_fail(file.commit());
    if (animation_viewer != nullptr) animation_viewer(drawn, Shown::in_file);
}

std::vector<animation::Scene> one_below_the_other(const animation::Scene& scene) {
    return {scene};
}

Animation drawn(const animation::Scene& scene) {
    return {animation::animated_svg(scene), animation::title_of(scene)};
}

Animation drawn(const animation::RigScene& rig) {
    return {animation::animated_svg(rig), animation::title_of(rig.bodies.front())};
}

/// Writes a file, calls the viewer, or plays in the terminal; `make` makes the scene of a part of the run.
template <class Make>
int animate(lua_State* L, const lua::Options& options, const motion::Run& run, const Make& make) {
    AnimateOptions asked;
    options.fill(asked);
    const bool writes = asked.file || animation_viewer != nullptr;
    if (!writes) refuse_no_terminal(options);
    const animation::Take take = asked_take(options, asked, run, writes ? most_frames_in_file : most_frames);
    if (asked.file) {
        write_animation(options, *asked.file, [&] { return drawn(make(take)); });
    } else if (writes) {
        animation_viewer(drawn(make(take)), Shown::here);
    } else {
        play(one_below_the_other(make(take)), asked);
        if (lua::interrupt_requested()) lua::raise_interrupted(L);
    }
    return 0;
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
    const auto take = asked_take(options, asked, run->result, most_frames_in_file);
    return drawn(asked_scene(L, options, run, take, asked_units(L, options).value_or(units_of(*run))));
}

int animate_run(lua_State* L) {
    lua::refuse_in_worker(L, "run:animate");
    const RunHandle run = lua::self<RunHandle>(L, 1, "run:animate()");
    const lua::Options options(L, 2, animate_call);
    const model::Units units = asked_units(L, options).value_or(units_of(*run));
    const motion::Run& whole = run->result;
    if (run->of_all()) {
        return animate(L, options, whole,
                       [&](const animation::Take& take) { return asked_rig(L, options, run, take, units); });
    }
    return animate(L, options, whole,
                   [&](const animation::Take& take) { return asked_scene(L, options, run, take, units); });
}

}  // namespace dinal::api
