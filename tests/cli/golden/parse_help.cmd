flightwatt parse --help
