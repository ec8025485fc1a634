// Where standard output goes: how wide it is, and what it can show.
#pragma once

#include "plots/canvas.hpp"

namespace dinal::plots {

struct Screen {
    bool terminal = false;
    int columns = 80;
    int rows = 24;
    Charset charset = Charset::ascii;  ///< braille when the locale is UTF-8
    bool colours = false;              ///< a terminal that has them, and NO_COLOR is not set
};

Screen screen();

}  // namespace dinal::plots
