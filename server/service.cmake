# The service as a library: HTTP, jobs, workers. Included by server/CMakeLists.txt.
find_package(Boost 1.74 REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(spdlog REQUIRED)
find_package(SQLiteCpp REQUIRED)
find_package(ZLIB REQUIRED)
# Its flags decide the layout of httplib's types, so they must be those of the library.
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib>=0.11)

# The description and the pages are part of the program: one file to install, none to lose.
set(SYMCELL_PAGE_FILES ${PROJECT_SOURCE_DIR}/openapi.yaml
                       ${CMAKE_CURRENT_LIST_DIR}/http/pages/index.html
                       ${CMAKE_CURRENT_LIST_DIR}/http/pages/docs.html)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${SYMCELL_PAGE_FILES})
file(READ ${PROJECT_SOURCE_DIR}/openapi.yaml SYMCELL_OPENAPI_YAML)
file(READ ${CMAKE_CURRENT_LIST_DIR}/http/pages/index.html SYMCELL_INDEX_PAGE)
file(READ ${CMAKE_CURRENT_LIST_DIR}/http/pages/docs.html SYMCELL_DOCS_PAGE)
configure_file(${CMAKE_CURRENT_LIST_DIR}/http/pages.cpp.in
               ${CMAKE_CURRENT_BINARY_DIR}/pages.cpp @ONLY)

add_library(
  symcell_service STATIC
  base/clock.cpp
  base/fault_archive.cpp
  base/files.cpp
  base/identifiers.cpp
  base/log.cpp
  base/metrics.cpp
  http/body_reader.cpp
  http/connection.cpp
  http/events_handler.cpp
  http/gzip.cpp
  http/header_values.cpp
  http/health_handlers.cpp
  http/http_server.cpp
  http/inflating_file.cpp
  http/inspect_handler.cpp
  http/job_document.cpp
  http/jobs_handlers.cpp
  http/json_envelope.cpp
  http/model_request.cpp
  http/page_handlers.cpp
  http/problem_response.cpp
  http/result_handlers.cpp
  http/router.cpp
  http/service.cpp
  http/task_queue.cpp
  jobs/job.cpp
  jobs/job_files.cpp
  jobs/job_runner.cpp
  jobs/job_service.cpp
  worker/local_engine.cpp
  jobs/retention.cpp
  jobs/sqlite_job_store.cpp
  worker/protocol.cpp
  worker/worker_engine.cpp
  worker/worker_faults.cpp
  worker/worker_main.cpp
  worker/worker_pool.cpp
  worker/worker_process.cpp
  ${CMAKE_CURRENT_BINARY_DIR}/pages.cpp)
if(SYMCELL_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Boost.Asio uses fences, which the sanitizer does not model; g++ warns wherever one is inlined.
  set_source_files_properties(jobs/job_runner.cpp jobs/job_service.cpp http/service.cpp
                              PROPERTIES COMPILE_OPTIONS -Wno-tsan)
endif()
target_link_libraries(
  symcell_service
  PUBLIC symcell_api symcell_process symcell_numerics Boost::headers Threads::Threads
  PRIVATE symcell_warnings PkgConfig::HTTPLIB OpenSSL::Crypto spdlog::spdlog SQLiteCpp ZLIB::ZLIB)

include(GNUInstallDirs)
install(FILES ${PROJECT_SOURCE_DIR}/openapi.yaml DESTINATION ${CMAKE_INSTALL_DATADIR}/symcell)
