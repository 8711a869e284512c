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
target_sources(
  symcell_core
  PRIVATE cells/verify_chains.cpp
          cells/verify_copies.cpp
          cells/verify_facets.cpp
          cells/verify_hanging.cpp
          cells/verify_links.cpp
          cells/verify_model.cpp
          cells/verify_pairs.cpp
          cells/verify_pieces.cpp
          cells/verify_pinches.cpp
          cells/verify_planar.cpp
          cells/verify_plc.cpp
          cells/verify_regions.cpp
          cells/verify_surface.cpp
          cells/verify_told.cpp)
