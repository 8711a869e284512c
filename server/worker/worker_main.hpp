// A worker process: takes requests from the server on one socket, one at a time, and runs them with
// the LocalEngine. Its main thread meshes; a second thread keeps the connection, so that a cancel
// is heard and the server's death noticed whatever the mesher does.
//
// A test hook: where the environment variable SYMCELL_WORKER_FAULTS is set, e.g. to
// "crash=7,hang=8", a request whose option `seed` is the number fails on purpose: `crash`
// (SIGSEGV), `abort`, `hang` (a loop that hears no cancel), `memory` (takes all it can get), `exit`
// (leaves with status 3). Whoever may set the server's environment owns the server anyway.
#pragma once

#include <sys/types.h>

namespace symcell::server {

// Serves requests on `socket` until its end; returns the exit status. `parent`: the process whose
// death ends this one.
[[nodiscard]] int run_worker(int socket, pid_t parent);

}  // namespace symcell::server
