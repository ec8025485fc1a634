#include "plots/animation/scene.hpp"

#include "support/catch.hpp"
#include "text/characters.hpp"

namespace dinal::text_frame_test {

using namespace dinal::plots;
using namespace dinal::plots::animation;

namespace {

Scene scene(bool spring) {
    Scene scene;
    scene.spring = spring;
    for (int i = 0; i <= 100; ++i) {
        const double theta = i / 50.0 - 1;
        scene.frames.push_back({.t = i / 10.0, .theta = theta, .stuck = i == 100, .surface = i / 100.0});
    }
    scene.reach = {-1, 1};
    return scene;
}

std::size_t place_of_mass(const std::string& line) {
    return line.find('#');
}

}  // namespace

TEST_CASE("each line of a frame fits, whatever the terminal", "[animation]") {
    for (const bool spring : {true, false}) {
        Scene all = scene(spring);
        all.walls = model::Walls{.lower = -1, .upper = 1};
        all.theta_unit = "a very long unit";
        for (const Charset charset : {Charset::ascii, Charset::braille}) {
            for (const int columns : {12, 20, 33, 80, 200}) {
                for (const Frame& frame : all.frames) {
                    const auto lines = text_frame(all, frame, {columns, charset, false});
                    REQUIRE(lines.size() == 5);
                    for (const std::string& line : lines) {
                        REQUIRE(text::columns(line) <= static_cast<std::size_t>(columns));
                    }
                }
            }
        }
    }
}

TEST_CASE("the mass goes evenly from one end of its reach to the other, and looks otherwise where it sticks",
          "[animation]") {
    const Scene all = scene(true);
    const FrameFormat format{80, Charset::ascii, false};
    const std::size_t first = place_of_mass(text_frame(all, all.frames[0], format)[1]);
    const std::size_t middle = place_of_mass(text_frame(all, all.frames[50], format)[1]);
    const std::size_t last = place_of_mass(text_frame(all, all.frames[99], format)[1]);
    CHECK(middle - first >= last - middle - 1);
    CHECK(middle - first <= last - middle + 2);
    const auto stuck = text_frame(all, all.frames[100], format);
    CHECK(stuck[1].find("XXXXX") != std::string::npos);
    CHECK(stuck[0] == "t = 10.0  theta = +1 rad  stuck");
    CHECK(text_frame(all, all.frames[0], format)[2].starts_with("|\\/\\/\\/\\/"));
    CHECK(text_frame(scene(false), all.frames[0], format)[2].starts_with(" "));
}

TEST_CASE("the pattern of a belt goes with it", "[animation]") {
    const Scene all = scene(true);
    const FrameFormat format{80, Charset::ascii, false};
    const std::string still = text_frame(all, all.frames[0], format)[3];
    CHECK(still.starts_with("---/---/"));
    CHECK(text_frame(all, all.frames[10], format)[3] != still);
}

}  // namespace dinal::text_frame_test
