#pragma once

namespace early_fusion::core {

/// Makes OpenMP's threads sleep soon when they wait for each other. By default they spin, and on a busy machine they
/// take the processor from the threads that they wait for.
///
/// The runtime reads its settings when a program is loaded, so this starts the program again with GOMP_SPINCOUNT. It
/// does nothing if OMP_WAIT_POLICY or GOMP_SPINCOUNT is set. To be called first in main().
void waitWithoutSpinning(char** argv);

}  // namespace early_fusion::core
