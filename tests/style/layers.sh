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
logging='spdlog|fmt/|iostream>|ostream>|cerr'
files='filesystem>|fstream>|fcntl\.h|sys/stat|dirent'
threads='thread>|mutex>|shared_mutex>|condition_variable>|future>|pthread|boost/thread'
stores='SQLiteCpp|sqlite3'

forbid core 'the core knows no other layer' 'api/|server/|tests/'
forbid core 'the core reads and writes nothing' "$json|$http|$logging|$files|$stores"
forbid core 'the core starts no threads' "$threads"
forbid core 'CGAL stays behind a few files: it costs 10 s a file that includes it' 'CGAL/' \
  'core/geometry/(predicates|predicates_3|facet_triangulation)\.cpp|core/solid/plc/plc_intersections\.cpp|core/surface/(self_intersections|mend_surface)\.cpp|core/initial/[a-z_]+\.[ch]pp'
forbid api 'api knows no server' 'server/|tests/'
forbid api 'api knows no sockets, threads or stores' "$http|$threads|$stores|$logging"
forbid api 'api does no geometry' "CGAL/|core/(tds|delaunay|initial|refine|improve)/"
forbid server 'the server does no geometry' \
  "CGAL/|core/(tds|delaunay|initial|refine|improve|geometry)/|tests/"
exit "$failed"
