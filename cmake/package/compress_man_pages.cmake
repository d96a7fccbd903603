# CPack runs this on what it is about to pack: Debian's man pages are compressed, and the same pages to the same bytes.
file(GLOB_RECURSE pages ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*.1)
list(FILTER pages INCLUDE REGEX "/man1/")
if(NOT pages)
  message(FATAL_ERROR "there are no man pages in ${CPACK_TEMPORARY_INSTALL_DIRECTORY}: build the target man_pages")
endif()
execute_process(COMMAND gzip --best --no-name ${pages} COMMAND_ERROR_IS_FATAL ANY)
