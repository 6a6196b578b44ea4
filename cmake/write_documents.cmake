# Script: writes what packages of the VERSION have beside what is built. Of the COMPONENT program: the manual page, which is
# the help of PROGRAM, below PREFIX/DATA/man, and the change log of SOURCE_DIR. Of both components: the licence. Change log
# and licence have the names and places that Debian gives them.
set(manual ${PREFIX}/${DATA}/man/man1)
set(documents ${PREFIX}/${DATA}/doc)
set(package noether)
if(COMPONENT STREQUAL "library")
  set(package noether-dev)
endif()

file(READ ${SOURCE_DIR}/LICENSE licence)
string(REGEX MATCH "Copyright[^\n]*" holder "${licence}")
string(REGEX REPLACE "^Copyright *(\\(c\\))? *" "" holder "${holder}")
string(REGEX REPLACE "^.*\n(Permission is hereby)" "\\1" licence "${licence}")
string(REGEX REPLACE "\n\n" "\n.\n" licence "${licence}")
string(STRIP "${licence}" licence)
string(REPLACE "\n" "\n " licence "${licence}")
file(WRITE ${documents}/${package}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: noether

Files: *
Copyright: ${holder}
License: Expat
 ${licence}
")

if(NOT COMPONENT STREQUAL "program")
  return()
endif()

# What a command prints, as roff shows it unchanged.
function(printed result)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=NOETHER_LAUNCHER ${PROGRAM} ${ARGN}
                  OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

execute_process(COMMAND ${PROGRAM} help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n  [a-z]+  " commands "${help}")
printed(options help)
set(page ".TH NOETHER 1 \"\" \"noether ${VERSION}\" \"User Commands\"
.SH NAME
noether \\- N-body and molecular dynamics on symplectic integrators
.SH SYNOPSIS
.B noether
.I COMMAND
[\\fIOPTIONS\\fR]
.SH DESCRIPTION
.nf
${options}.fi
")
foreach(command IN LISTS commands)
  string(STRIP "${command}" command)
  printed(help help ${command})
  string(TOUPPER ${command} title)
  string(APPEND page ".SH ${title}\n.nf\n${help}.fi\n")
endforeach()
string(APPEND page ".SH EXIT STATUS
0: done, or stopped as the scene asked; 1: the physics or the method stopped the run; 2: the request is wrong; 3: a file could
not be read or written; 4: a fault of the program, or out of memory; 130: interrupted, the checkpoint is written.
.SH SEE ALSO
/${DATA}/doc/noether has examples and documents.
")
file(WRITE ${manual}/noether.1 "${page}")

find_program(gzip gzip)
file(COPY_FILE ${SOURCE_DIR}/CHANGELOG.md ${documents}/noether/changelog)
if(gzip)
  execute_process(COMMAND ${gzip} -9nf ${manual}/noether.1 ${documents}/noether/changelog COMMAND_ERROR_IS_FATAL ANY)
endif()
