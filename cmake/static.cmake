# flightwatt_static: the objects of flightwatt with static libraries, so that the program runs on every Linux of its
# processor, without a file of the system. Left out where a library is missing: scripts/install_dependencies package.
if(NOT CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)
  return()  # cmake/static/left_out.cpp has names of x86-64
endif()
set(static_libraries)
foreach(library ceres glog gflags lzma bz2 zstd z GeographicLib pugixml boost_iostreams boost_program_options)
  find_library(FLIGHTWATT_STATIC_${library} lib${library}.a)
  mark_as_advanced(FLIGHTWATT_STATIC_${library})
  if(NOT FLIGHTWATT_STATIC_${library})
    return()
  endif()
  list(APPEND static_libraries ${FLIGHTWATT_STATIC_${library}})
endforeach()
get_property(modules GLOBAL PROPERTY flightwatt_modules)
list(TRANSFORM modules REPLACE "(.+)" "$<TARGET_FILE:\\1>")

# Position-independent, as all of Debian's programs: -static-pie.
set(static_folder ${PROJECT_BINARY_DIR}/static)
add_executable(flightwatt_static EXCLUDE_FROM_ALL
  $<TARGET_OBJECTS:flightwatt> $<TARGET_OBJECTS:program_commit> cmake/static/formatting.cpp cmake/static/left_out.cpp)
target_link_libraries(flightwatt_static PRIVATE
  -Wl,--start-group ${modules} ${static_libraries} -Wl,--end-group)
target_link_options(flightwatt_static PRIVATE -static-pie -s LINKER:-Map=${static_folder}/flightwatt.map)
set_target_properties(flightwatt_static PROPERTIES OUTPUT_NAME flightwatt RUNTIME_OUTPUT_DIRECTORY ${static_folder})
