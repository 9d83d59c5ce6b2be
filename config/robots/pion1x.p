;; Parameters of the Pioneer 1 with the server pion1x.
;;
;; Conversion factors, limits, radius and sonar places are the values of ARIA and Player for this
;; subclass. Accelerations, batteries, encoders and errors are assumed: plausible settings for such
;; a robot. Keywords: README.md.

Class     Pioneer
Subclass  pion1x
Protocol  psos

;; Values of one unit of the packets
AngleConvFactor  0.0061359  ; rad
DistConvFactor   0.05066    ; mm
VelConvFactor    2.5332     ; mm/s
RangeConvFactor  0.1734     ; mm
DiffConvFactor   0.00333333 ; rad of turn per mm of half the difference of the wheel distances
Vel2Divisor      4          ; mm/s

RobotRadius      220        ; mm
RobotDiagonal    90         ; mm, half-height to the diagonal of the octagon

MaxVelocity      400        ; mm/s
MaxRVelocity     100        ; deg/s
Acceleration     500        ; mm/s2
Deceleration     2000       ; mm/s2
RotAcceleration  300        ; deg/s2
RotDeceleration  300        ; deg/s2

;; Errors of the simulated dead reckoning (terms of the manual's Table 3-1)
EncodeJitter     0.01
AngleJitter      0.02
AngleDrift       0.003

;; Equipment
Battery           12.6      ; V

;; Sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings on each side
FrontMaxRange    2500       ; mm

SonarNum 7
SonarArrays 1   ; arrays that fire at the same time
SonarPeriod 40  ; ms between two firings of an array
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0   100   100    90
SonarUnit  1   120    80    30
SonarUnit  2   130    40    15
SonarUnit  3   130     0     0
SonarUnit  4   130   -40   -15
SonarUnit  5   120   -80   -30
SonarUnit  6   100  -100   -90
