flightwatt simulate one two
