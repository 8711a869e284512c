target_sources(
  symcell_core
  PRIVATE geometry/predicates_3.cpp
          tds/validate_tetrahedra.cpp
          cells/build_solid_cell_mesh.cpp
          cells/cell_topology.cpp
          cells/minimise_bound.cpp
          cells/repair_cell.cpp
          cells/representatives.cpp
          cells/sector_regions.cpp
          cells/solid_cell.cpp)
target_sources(symcell_core PRIVATE cells/boundary_faces.cpp)
target_sources(symcell_core PRIVATE cells/verify_links.cpp cells/verify_plc.cpp cells/verify_surface.cpp cells/verify_told.cpp)
