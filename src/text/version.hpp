// The version of the program. CMakeLists.txt and the scripts read it here.
#pragma once

#define DINAL_VERSION "0.2.0"  // a macro, as it is joined to other literals
