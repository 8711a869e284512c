// What a process that meshes for another may still do: read and write files, take memory, start
// threads and children of its own. The models it reads come from strangers, and are read by libraries
// that were not written for strangers.
#pragma once

namespace symcell::server {

// From now on this process and its children gain no rights by what they start, open few files at
// once, and make no system call but those that meshing needs: none that starts another program,
// opens a socket, traces a process or mounts. A call that is not allowed fails with EPERM. Cannot be
// undone.  False: the kernel knows no filters, and only the rest holds.  Not under sanitizers.
[[nodiscard]] bool give_up_rights();

}  // namespace symcell::server
