# Runs after the link of airlight_tests: registers its tests with ctest, as a process per file of tests, because a process takes 60 ms to
# start and most tests take less. Tests of their own process are those on the device, which compile shaders; [slow] ones, so that they
# begin first; [thorough] ones, which scripts/test leaves to --all; and [skips], which may say that they cannot run here.
#
#   cmake -D TESTS=PROGRAM -D ROOT=SOURCES -D SHADERS=FOLDER -D OUT=FILE -P tests/register.cmake
set(by_file "~[gpu]~[slow]~[thorough]~[skips]~[.]")
set(alone "[gpu]~[thorough]~[.],[slow]~[thorough]~[.],[skips]~[thorough]~[.]")
set(text)

function(register name cost labels)
  set(properties "WORKING_DIRECTORY;${ROOT};TIMEOUT;600;FIXTURES_REQUIRED;shaders;ENVIRONMENT;AIRLIGHT_DUMP_SHADERS=${SHADERS};COST;${cost}")
  if(labels)
    list(APPEND properties LABELS "${labels}")
  endif()
  set(command)
  foreach(argument ${ARGN})
    string(APPEND command " [==[${argument}]==]")
  endforeach()
  string(APPEND text "add_test([==[${name}]==] [==[${TESTS}]==]${command})\nset_tests_properties([==[${name}]==] PROPERTIES")
endfunction()
