target_sources(
  symcell_core
  PRIVATE backends/child_process.cpp
          backends/tetgen_backend.cpp
          initial/cut_section.cpp
          initial/initial_tetrahedralization.cpp
          initial/solid_starts.cpp
          initial/sector_mesh.cpp
          initial/sector_parts.cpp)
