flightwatt parse
