// Which share of a work that several processes do together is ours, as the launcher tells: mpirun, srun, a job array.
#pragma once

#include <optional>
#include <string>

#include "text/expected.hpp"

namespace dinal::files {

struct Share {
    long long rank = 0;  ///< from 0
    long long size = 1;  ///< how many processes there are
};

/// Reads the environment: DINAL_RANK and DINAL_SIZE, which anybody may set (GNU parallel, a loop in a shell); those of
/// Open MPI, PMI (MPICH, Intel MPI), Slurm's srun, and of Slurm's job arrays. None outside of a launcher, as
/// in the shell of a batch job of Slurm. Fails when there is a rank and no size, or what is there are no such numbers.
text::Expected<std::optional<Share>> share_of_launcher();

}  // namespace dinal::files
