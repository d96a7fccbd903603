flightwatt simulate --help
