flightwatt --help && flightwatt -h
