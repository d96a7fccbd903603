# The Debian package of the programs, by CPack: scripts/package. What programs need besides is found by dpkg-shlibdeps.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME flightwatt)
set(CPACK_PACKAGE_CONTACT "FlightWatt developers <developers@flightwatt.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "energy of electric drone missions from flight logs")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"FlightWatt reads the logs of Paparazzi autopilots, fits the mechanical power of
an aircraft, adds what its computer and its software draw, and simulates and
plans missions on a battery: state of charge over time, and how surely a
mission keeps its reserve.

Programs for single steps, for whole folders of logs, for a flight that is in
the air, and for a report as one page that is read offline.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_THREADS 0)
set(CPACK_COMPONENTS_ALL programs debian)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Figures as files: by node as SVG, by rsvg-convert as PDF. The page needs neither.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "nodejs (>= 18), librsvg2-bin")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/compress_man_pages.cmake)

# What Debian wants beside the programs; scripts/package writes it into the build.
set(documents ${PROJECT_BINARY_DIR}/package/documents)
install(FILES ${documents}/copyright ${documents}/changelog.gz ${documents}/changelog.Debian.gz
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/flightwatt COMPONENT debian EXCLUDE_FROM_ALL)
include(CPack)
