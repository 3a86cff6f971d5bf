"""All chapters of faults, in the order of the table."""

import faults_of_bench
import faults_of_calibration
import faults_of_cleaning
import faults_of_footage
import faults_of_output
import faults_of_take

CHAPTERS = (
    faults_of_take.FILE,
    faults_of_take.VALUES,
    faults_of_calibration.FILE,
    faults_of_calibration.CAMERAS,
    faults_of_footage.FILES,
    faults_of_footage.MASKS,
    faults_of_output.OUTPUT,
    faults_of_cleaning.CLEANING,
    faults_of_bench.BENCH,
)
