;; Parameters of the Pioneer 2 DX8 Plus.
;;
;; Conversion factors, limits, radius and sonar places are the values of ARIA and Player for this
;; subclass. Accelerations, batteries, encoders and errors are assumed: plausible settings for such
;; a robot. Keywords: README.md.

Class     Pioneer
Subclass  p2d8+
Protocol  p2os

;; Values of one unit of the packets
AngleConvFactor  0.00153398 ; rad
DistConvFactor   0.485      ; mm
VelConvFactor    1          ; mm/s
RangeConvFactor  1          ; mm
DiffConvFactor   0.0056     ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      20         ; mm/s

RobotRadius      250        ; mm
RobotDiagonal    120        ; mm, half-height to the diagonal of the octagon
RobotWidth       425        ; mm
RobotLength      511        ; mm

MaxVelocity      2200       ; mm/s
MaxRVelocity     500        ; deg/s
Acceleration     300        ; mm/s2
Deceleration     300        ; mm/s2
RotAcceleration  100        ; deg/s2
RotDeceleration  100        ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.01
AngleJitter      0.01
AngleDrift       0.001

;; Equipment
Battery           12.8      ; V
LowBattery        11.5      ; V
ShutdownVolts     11.0      ; V
EncoderTicksPerMM 128       ; counts
NumFrontBumpers   5
NumRearBumpers    5

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

SonarNum 16
SonarArrays 2   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0    69   136    90
SonarUnit  1   114   119    50
SonarUnit  2   148    78    30
SonarUnit  3   166    27    10
SonarUnit  4   166   -27   -10
SonarUnit  5   148   -78   -30
SonarUnit  6   114  -119   -50
SonarUnit  7    69  -136   -90
SonarUnit  8  -157  -136   -90
SonarUnit  9  -203  -119  -130
SonarUnit 10  -237   -78  -150
SonarUnit 11  -255   -27  -170
SonarUnit 12  -255    27   170
SonarUnit 13  -237    78   150
SonarUnit 14  -203   119   130
SonarUnit 15  -157   136    90
