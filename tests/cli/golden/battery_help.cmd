flightwatt battery --help
