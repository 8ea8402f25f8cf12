# cmake --install: the programs, what they read, headers, libraries and the package for find_package(airlight).
#   bin/                airlight, airlight_studies
#   lib/airlight/       airlight_vdb.so, which programs load when they first meet an OpenVDB file; libraries for programs of others
#   lib/cmake/airlight/ the package
#   include/airlight/   headers, named as in the sources: #include "scene/renderer.h"
#   share/              manual pages, completion for bash, zsh and fish
#   share/airlight/     experiments, records of results, oracle vectors, shaders: the project that the program finds
set(room lib/airlight)
set(package lib/cmake/airlight)
install(TARGETS airlight airlight_studies RUNTIME DESTINATION bin)
set_target_properties(airlight airlight_studies PROPERTIES INSTALL_RPATH "$ORIGIN/../${room}")
install(TARGETS airlight_vdb LIBRARY DESTINATION ${room})

set(floors flags scene methods reference gpu experiments without_studies processor)
foreach(floor ${floors})
  set_target_properties(airlight_${floor} PROPERTIES EXPORT_NAME ${floor})
  list(APPEND libraries_of_floors airlight_${floor})
endforeach()
install(TARGETS ${libraries_of_floors} EXPORT airlight ARCHIVE DESTINATION ${room} OBJECTS DESTINATION ${room})
# Where programs of others find airlight_vdb.so.
target_link_options(airlight_flags INTERFACE "$<INSTALL_INTERFACE:-Wl,-rpath,$<INSTALL_PREFIX>/${room},--disable-new-dtags>")
install(EXPORT airlight NAMESPACE airlight:: FILE airlightTargets.cmake DESTINATION ${package})
include(CMakePackageConfigHelpers)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/airlightConfigVersion.cmake" COMPATIBILITY ExactVersion)
install(FILES cmake/airlightConfig.cmake "${CMAKE_BINARY_DIR}/airlightConfigVersion.cmake" DESTINATION ${package})

foreach(folder scene methods reference gpu experiments)
  install(DIRECTORY ${folder} DESTINATION include/airlight FILES_MATCHING PATTERN "*.h")
endforeach()
install(DIRECTORY experiments DESTINATION share/airlight PATTERN "*.cpp" EXCLUDE PATTERN "*.h" EXCLUDE)
install(DIRECTORY tests/vectors DESTINATION share/airlight/tests)
install(DIRECTORY gpu DESTINATION share/airlight
        FILES_MATCHING PATTERN "*.comp" PATTERN "*.glsl" PATTERN "*.vert" PATTERN "*.frag")
# Records and tables; not the pictures, nor what runs of experiments leave beside them.
install(DIRECTORY results DESTINATION share/airlight
        FILES_MATCHING PATTERN "run.json" PATTERN "*.csv" PATTERN "table.md"
        PATTERN "cache" EXCLUDE PATTERN "images" EXCLUDE PATTERN "rows" EXCLUDE PATTERN "report" EXCLUDE PATTERN "gallery" EXCLUDE)
# The program describes itself to shells and man.
install(CODE "
  set(share \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share\")
  foreach(file bash-completion/completions/airlight zsh/site-functions/_airlight fish/vendor_completions.d/airlight.fish)
    string(REGEX MATCH \"^[a-z]+\" shell \"\${file}\")
    execute_process(COMMAND \"$<TARGET_FILE:airlight>\" completion \${shell} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
    file(WRITE \"\${share}/\${file}\" \"\${text}\")
  endforeach()
  execute_process(COMMAND \"$<TARGET_FILE:airlight>\" man --out \"\${share}/man/man1\" COMMAND_ERROR_IS_FATAL ANY)
")
install(FILES LICENSE NOTICE README.md DESTINATION share/airlight)
