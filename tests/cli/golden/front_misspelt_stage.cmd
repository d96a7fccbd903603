flightwatt segmnet x.data
