# mcdbn_separate(FILES…): sources, as patterns below this folder, that define the same names for themselves as
# others do (each reader its `read`), so that scripts/build does not join them (CMAKE_UNITY_BUILD).
function(mcdbn_separate)
  if(ARGN)
    list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    file(GLOB separate ${ARGN})
    set_source_files_properties(${separate} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

# mcdbn_room(NAME [SEPARATE FILES…] [USES ROOM…] [LIBRARIES TARGET…]): the sources of src/NAME as the library
# mcdbn_NAME. SEPARATE: as mcdbn_separate.
# A room may include the headers of the rooms that it uses and of all behind those, and links them;
# `scripts/lint rooms` reads these declarations and fails on any other include.
function(mcdbn_room name)
  cmake_parse_arguments(ROOM "" "" "SEPARATE;USES;LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS src/${name}/*.cpp src/${name}/*/*.cpp)
  list(TRANSFORM ROOM_USES PREPEND mcdbn_)
  add_library(mcdbn_${name} STATIC ${sources})
  target_include_directories(mcdbn_${name} PUBLIC ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/src
                                           PRIVATE ${CMAKE_SOURCE_DIR}/kernels)
  target_link_libraries(mcdbn_${name} PUBLIC ${ROOM_USES} ${ROOM_LIBRARIES} Eigen3::Eigen
                                             nlohmann_json::nlohmann_json fmt::fmt spdlog::spdlog
                                      PRIVATE mcdbn_warnings)
  set_target_properties(mcdbn_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  list(TRANSFORM ROOM_SEPARATE PREPEND src/${name}/)
  mcdbn_separate(${ROOM_SEPARATE})
  mcdbn_precompile(mcdbn_${name} mcdbn_base)
  set(MCDBN_ROOMS ${MCDBN_ROOMS} ${name} PARENT_SCOPE)
endfunction()

# mcdbn_library(NAME ROOMS ROOM… PUBLIC TARGET… PRIVATE TARGET…): what is installed as mcdbn::NAME, made of
# these rooms.
function(mcdbn_library name)
  cmake_parse_arguments(LIBRARY "" "" "ROOMS;PUBLIC;PRIVATE" ${ARGN})
  set(target mcdbn_library_${name})
  add_library(${target})
  add_library(mcdbn::${name} ALIAS ${target})
  foreach(room ${LIBRARY_ROOMS})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:mcdbn_${room}>)
  endforeach()
  string(REPLACE mcdbn_mcdbn mcdbn output mcdbn_${name})
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX POSITION_INDEPENDENT_CODE ON
                                             OUTPUT_NAME ${output} EXPORT_NAME ${name}
                                             ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${LIBRARY_PUBLIC} PRIVATE ${LIBRARY_PRIVATE})
endfunction()
