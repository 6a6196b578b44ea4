# Script: writes OUTPUT from TEMPLATE with VERSION and the commit of SOURCE_DIR, if that changes it.
set(COMMIT "unknown")
find_program(git git)
if(git)
  # A checkout may belong to another user than the one who builds.
  execute_process(COMMAND ${git} -c safe.directory=* -C ${SOURCE_DIR} rev-parse --show-toplevel
                  OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  file(REAL_PATH "${SOURCE_DIR}" source)
  if(top STREQUAL source)
    execute_process(COMMAND ${git} -c safe.directory=* -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude *
                    OUTPUT_VARIABLE described RESULT_VARIABLE status OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(status EQUAL 0)
      set(COMMIT "${described}")
    endif()
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
