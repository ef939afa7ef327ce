"""Files: what a file of a run contains, and how files are written and read.

`variables`    how a variable of a file is declared, and every one that a run can put there
`dataset`      the dataset of a run, with CF names and units
`provenance`   where a file comes from: settings, seed, versions
`output_lock`  one writer for one file
`output_path`  the one way to write a file: its path is checked, and it is there whole or not at all
`validity`     checks of a file before its numbers are loaded
`netcdf`       write datasets to netCDF files, and read them
`checkpoint`   the file of a run that is not finished
`molecules`    the molecules of a saved run, frame by frame
`export`       a saved run for other programs
"""
