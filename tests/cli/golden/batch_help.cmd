flightwatt batch --help
