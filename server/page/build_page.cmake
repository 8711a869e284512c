# Builds the bundle of the pages in WORK and writes OUTPUT, a C++ file that holds its files, each packed by
# gzip; none where the bundle cannot be built for want of npm or its registry. A fault in the sources fails.
set(folder ${WORK}/tree/server/page)

function(build_bundle result)
  set(${result} "" PARENT_SCOPE)
  if(BUNDLE)
    set(${result} ${BUNDLE} PARENT_SCOPE)
    return()
  endif()
  if(NOT NPM)
    message(STATUS "no npm: the program will serve plain pages, without a viewer")
    return()
  endif()
  # In a tree of its own, so that the source tree stays as it is.
  foreach(file ${FILES})
    get_filename_component(place ${file} DIRECTORY)
    file(COPY ${SOURCE}/${file} DESTINATION ${folder}/${place})
  endforeach()
  file(COPY ${EXAMPLES} DESTINATION ${WORK}/tree/docs)

  file(SHA256 ${SOURCE}/package-lock.json lock)
  set(stamp ${folder}/node_modules/.symcell-lock)
  set(installed "")
  if(EXISTS ${stamp})
    file(READ ${stamp} installed)
  endif()
  if(NOT installed STREQUAL lock)
    execute_process(
      COMMAND ${NPM} ci --prefer-offline --ignore-scripts --no-progress --fetch-retries=1 WORKING_DIRECTORY ${folder}
      RESULT_VARIABLE failed OUTPUT_VARIABLE words ERROR_VARIABLE words)
    if(failed)
      message(STATUS "npm ci could not install what the pages need; the program will serve plain pages, "
                     "without a viewer:\n${words}")
      return()
    endif()
    file(WRITE ${stamp} ${lock})
  endif()
  set(ENV{SYMCELL_PAGE_OUT} ${WORK}/dist)
  execute_process(COMMAND ${NPM} run --silent build WORKING_DIRECTORY ${folder} RESULT_VARIABLE failed
                  OUTPUT_VARIABLE words ERROR_VARIABLE words)
  if(failed)
    message(FATAL_ERROR "the pages do not build:\n${words}")
  endif()
  set(${result} ${WORK}/dist PARENT_SCOPE)
endfunction()

function(media_type_of file result)
  set(types .html "text/html\; charset=utf-8" .js "text/javascript\; charset=utf-8" .css "text/css\; charset=utf-8"
            .svg image/svg+xml .json application/json .stl model/stl)
  get_filename_component(ending ${file} LAST_EXT)
  list(FIND types ${ending} at)
  if(at LESS 0)
    message(FATAL_ERROR "the pages have a file of a kind that is not known: ${file}")
  endif()
  math(EXPR at "${at} + 1")
  list(GET types ${at} type)
  set(${result} "${type}" PARENT_SCOPE)
endfunction()

build_bundle(bundle)
set(data "")
set(rows "")
set(count 0)
if(bundle)
  file(GLOB_RECURSE built RELATIVE ${bundle} ${bundle}/*)
  list(SORT built)
  foreach(file ${built})
    media_type_of(${file} type)
    set(packed ${WORK}/packed/${count}.gz)
    file(MAKE_DIRECTORY ${WORK}/packed)
    execute_process(COMMAND gzip -9nc ${bundle}/${file} OUTPUT_FILE ${packed} RESULT_VARIABLE failed)
    if(failed)
      message(FATAL_ERROR "gzip could not pack ${file}")
    endif()
    set(path /${file})
    if(file STREQUAL index.html)
      set(path /)
    elseif(file STREQUAL docs.html)
      set(path /docs)
    endif()
    # The assembler takes the bytes as they are; a compiler would read a number for each.
    string(APPEND data "asm(\".section .rodata\\n.global symcell_page_${count}\\nsymcell_page_${count}:\\n.incbin \\\"${packed}\\\"\\n\"\n"
                       "    \".global symcell_page_${count}_end\\nsymcell_page_${count}_end:\\n.byte 0\\n.previous\\n\");\n"
                       "extern \"C\" const char symcell_page_${count}[], symcell_page_${count}_end[];\n")
    string(APPEND rows "      {\"${path}\", \"${type}\", {symcell_page_${count}, "
                       "static_cast<std::size_t>(symcell_page_${count}_end - symcell_page_${count})}},\n")
    math(EXPR count "${count} + 1")
  endforeach()
endif()

file(WRITE ${OUTPUT} "// Made by server/page/build_page.cmake.\n#include \"server/http/page_files.hpp\"\n\n${data}\n"
"namespace symcell::server {\n\nstd::span<const PageFile> page_files() {\n"
"  static const std::vector<PageFile> files{\n${rows}  };\n  return files;\n}\n\n}  // namespace symcell::server\n")
