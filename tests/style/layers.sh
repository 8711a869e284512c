#!/usr/bin/env bash
# Dependencies point one way, core <- api <- server, and each layer keeps to its own trade: fails
# with file and line for every #include that a folder must not have.
set -euo pipefail
cd "$1"
failed=0

# forbid FOLDER WHY PATTERN [ALLOWED]: no header that matches PATTERN (the text between the quotes
# or brackets of an #include) under FOLDER, files that match ALLOWED excepted.
forbid() {
  local folder=$1 why=$2 pattern=$3 allowed=${4-^$} hits
  hits=$(grep -rnE --include='*.hpp' --include='*.cpp' --include='*.in' \
    "^ *# *include *[<\"]($pattern)" "$folder" | grep -vE "^($allowed):" || true)
  if [[ -n $hits ]]; then
    printf '%s: %s\n%s\n' "$folder" "$why" "$hits" >&2
    failed=1
  fi
}

json='nlohmann/|pugixml|zlib\.h'
http='httplib|openssl/|boost/asio|sys/socket|netinet/|arpa/|netdb'
logging='spdlog|fmt/|iostream>|ostream>'
files='filesystem>|fstream>|fcntl\.h|sys/stat|dirent'
threads='thread>|mutex>|shared_mutex>|condition_variable>|future>|pthread|boost/thread'
stores='SQLiteCpp|sqlite3'

forbid core 'the core knows no other layer' 'api/|server/|tests/'
forbid api/cad 'the module of OpenCASCADE knows nothing but its interface' 'api/(formats|schema|[a-z_]*\.)|core/|server/|tests/'
forbid server 'files are read by the api' 'api/cad/'
forbid core 'the core reads and writes nothing' "$json|$http|$logging|$files|$stores"
forbid core 'the core starts no threads' "$threads"
forbid core 'CGAL stays behind a few files: it costs 10 s a file that includes it' 'CGAL/' \
  'core/geometry/(predicates|predicates_3|facet_triangulation|self_intersections)\.cpp|core/plane/initial/(full_cdt|initial_triangulation)\.[ch]pp|core/solid/(initial/cut_section|plc/plc_intersections|surface/(arrangement|mend_surface|wrap_surface))\.cpp'

# The rooms of the core, from the ground up: each knows those named before it, the wings not each
# other, and the checker of files no code that makes meshes.
rooms=(base geometry model cell guard)
for ((i = 0; i < ${#rooms[@]}; ++i)); do
  higher=$(IFS='|'; echo "${rooms[*]:i+1}")
  forbid "core/${rooms[i]}" 'a room knows those below it only' \
    "core/((${higher:-none}|plane|solid|verify)/|mesh_model)"
done
forbid core/plane 'the wings do not know each other' 'core/((solid|verify)/|mesh_model)'
forbid core/solid 'the wings do not know each other' 'core/((plane|verify)/|mesh_model)'
forbid core/verify 'what checks meshes shares no code with what makes them' \
  'core/(guard/|mesh_model|(plane|solid)/(mesh_|cut|delaunay|improve|initial|quotient|refine|sector|symmetry))'
forbid core/plane/quotient 'the data structure knows no algorithm' 'core/plane/(cut|delaunay|initial|refine)/'
forbid core/solid/quotient 'the data structure knows no algorithm' \
  'core/solid/(cut|delaunay|improve|initial|refine|sector)/'

wings='core/(plane|solid|guard)/'
forbid api 'api knows no server' 'server/|tests/'
forbid api 'api knows no sockets, threads or stores' "$http|$threads|$stores|$logging"
forbid api 'api does no geometry' "CGAL/|$wings"
forbid server 'the server does no geometry' "CGAL/|$wings|core/geometry/|tests/"
forbid server/jobs 'jobs know no worker: engines are handed to them' 'server/(worker|http|cli)/'
forbid server/worker 'workers know no HTTP' 'server/(http|cli)/'
exit "$failed"
