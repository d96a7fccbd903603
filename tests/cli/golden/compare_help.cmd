flightwatt compare --help
