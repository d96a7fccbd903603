flightwatt segment --help
