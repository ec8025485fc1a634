// The files that wait under another name until they are whole, so that a signal which ends the program can take them
// along.
#pragma once

#include <string>

namespace dinal::files {

/// The file of that name is removed when SIGTERM, SIGHUP or SIGQUIT ends the program, until it is forgotten.
void note_temporary(const std::string& name);
void forget_temporary(const std::string& name);

/// From now on. A signal that is ignored (nohup) stays so. SIGXFSZ becomes an error of the file that is too large.
void clean_up_on_signals();

}  // namespace dinal::files
