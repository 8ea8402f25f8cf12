# Writes OUT, which registers the tests of PROGRAM that match TAGS with ctest, a process per name of a file of tests: a process takes
# 60 ms to start, most tests take less.
execute_process(COMMAND "${PROGRAM}" --filenames-as-tags "${TAGS}" --list-tags WORKING_DIRECTORY "${FOLDER}" OUTPUT_VARIABLE tags)
string(REGEX MATCHALL "\\[#[^]]+]" files "${tags}")
if(NOT files)
  message(FATAL_ERROR "${PROGRAM} names no file of tests: ${tags}")
endif()
set(text)
foreach(file ${files})
  string(REGEX REPLACE "[][#]" "" name "${file}")
  string(APPEND text "add_test(\"${name}\" \"${PROGRAM}\" --filenames-as-tags \"${file}${TAGS}\")\n"
                     "set_tests_properties(\"${name}\" PROPERTIES WORKING_DIRECTORY \"${FOLDER}\" ${PROPERTIES})\n")
endforeach()
file(WRITE "${OUT}" "${text}")
