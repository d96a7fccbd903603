flightwatt profile --help
