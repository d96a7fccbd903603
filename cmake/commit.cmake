# Writes the C++ source OUTPUT, which defines the commit of the source tree SOURCE; run at every build. The file changes
# only with the commit. Without git and without a repository of its own the tree has no commit.
#   cmake -D SOURCE=FOLDER -D OUTPUT=FILE -P commit.cmake
cmake_minimum_required(VERSION 3.23)
set(commit "")
find_program(GIT git)
if(GIT)
  # A hook of git sets variables that name a repository.
  set(git ${CMAKE_COMMAND} -E env --unset=GIT_DIR --unset=GIT_WORK_TREE ${GIT} -C ${SOURCE})
  execute_process(COMMAND ${git} rev-parse --show-toplevel OUTPUT_VARIABLE top RESULT_VARIABLE failed
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    file(REAL_PATH "${SOURCE}" source)
    file(REAL_PATH "${top}" top)
    if(top STREQUAL source)  # not a repository that the tree only lies in
      execute_process(COMMAND ${git} rev-parse --short HEAD OUTPUT_VARIABLE commit RESULT_VARIABLE failed
                      OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
      if(failed)
        set(commit "")  # nothing is committed yet
      endif()
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT
"namespace flightwatt::cli {

const char* commit();
const char* commit() { return \"${commit}\"; }

}  // namespace flightwatt::cli
")
