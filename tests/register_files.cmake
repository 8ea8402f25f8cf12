# Writes OUT, which registers the tests of PROGRAM that match TAGS with ctest: a process per name of a file for those of the tag [gpu],
# which begin first, and one for all others. Where there is no device, ctest counts the former as skipped. It knows them by a line that no test
# writes where there is one: any other reason to skip a test would hide what fails in another test of its file.
set(text)
foreach(device "[gpu]" "~[gpu]")
  execute_process(COMMAND "${PROGRAM}" --filenames-as-tags "${device}${TAGS}" --list-tags WORKING_DIRECTORY "${FOLDER}" OUTPUT_VARIABLE tags)
  string(REGEX MATCHALL "\\[#[^]]+]" files "${tags}")
  if(NOT files)
    message(FATAL_ERROR "${PROGRAM} names no file of tests: ${device}${TAGS}")
  endif()
  foreach(file ${files})
    string(REGEX REPLACE "[][#]" "" name "${file}")
    set(more)
    if(device STREQUAL "[gpu]")
      string(APPEND name " on the device")
      set(more "COST 10 SKIP_REGULAR_EXPRESSION \"test skipped: no device\"")
    endif()
    string(APPEND text "add_test(\"${name}\" \"${PROGRAM}\" --filenames-as-tags \"${file}${device}${TAGS}\")\n"
                       "set_tests_properties(\"${name}\" PROPERTIES WORKING_DIRECTORY \"${FOLDER}\" ${PROPERTIES} ${more})\n")
  endforeach()
endforeach()
file(WRITE "${OUT}" "${text}")
