// The version of the program. CMakeLists.txt and the scripts read it here.
#pragma once

#define DINAL_VERSION "0.3.0"  // a macro, because it becomes part of longer literals
