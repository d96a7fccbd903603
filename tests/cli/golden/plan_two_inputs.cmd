flightwatt plan one two
