flightwatt parse one two
