;; Parameters of the Pioneer 1 whose server calls itself psos1x.
;;
;; Conversion factors, limits, radius and the places of the sonars are those that ARIA and Player use
;; for this subclass. Accelerations, batteries, encoders and errors are ours: settings that such a
;; robot may have. Keywords: README.md.

Class     Pioneer
Subclass  psos1x
Protocol  psos

;; One unit of the packets
AngleConvFactor  0.0061359  ; rad
DistConvFactor   0.05066    ; mm
VelConvFactor    2.5332     ; mm/s
RangeConvFactor  0.1734     ; mm
DiffConvFactor   0.00333333 ; rad of turn per mm of half the difference of the wheels
Vel2Divisor      4          ; mm/s

RobotRadius      220        ; mm
RobotDiagonal    90         ; mm, half-height to the diagonal of the octagon

MaxVelocity      400        ; mm/s
MaxRVelocity     100        ; deg/s
Acceleration     500        ; mm/s2
Deceleration     2000       ; mm/s2
RotAcceleration  300        ; deg/s2
RotDeceleration  300        ; deg/s2

;; Errors of the simulated dead reckoning (Table 3-1 of the manual)
EncodeJitter     0.01
AngleJitter      0.02
AngleDrift       0.003

;; Equipment
Battery           12.6      ; V

;; The sonar buffers of the LPS
FrontBuffer      30         ; readings
SideBuffer       40         ; readings of each side
FrontMaxRange    2500       ; mm

SonarNum 7
SonarArrays 1   ; that fire at the same time
SonarPeriod 40  ; ms from one firing of an array to its next
;;         #     x     y    th    mm, mm, degrees
SonarUnit  0   100   100    90
SonarUnit  1   120    80    30
SonarUnit  2   130    40    15
SonarUnit  3   130     0     0
SonarUnit  4   130   -40   -15
SonarUnit  5   120   -80   -30
SonarUnit  6   100  -100   -90
